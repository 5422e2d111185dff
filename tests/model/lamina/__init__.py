"""Tests of the lamina."""
