"""Tests of the medulla."""
