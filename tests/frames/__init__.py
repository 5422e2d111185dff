"""Tests of where frames come from; ``clips`` writes the little movies they read."""
