"""Slow, obvious versions of the model, written from its equations alone: plain lists, double loops, no lobula."""
