"""Searches for settings over the ranges written beside the parameters; every result with a held-out score."""
