"""Experiments: what the network does on movies whose answer is known, one file per table or figure."""
