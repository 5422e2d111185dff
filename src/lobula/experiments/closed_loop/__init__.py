"""Whole runs of the arena: the paper's table, and what its numbers hang on."""
