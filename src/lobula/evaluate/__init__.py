"""Labelled clips in, hits, lead times and false alarms out, each with what chance alone would give."""
