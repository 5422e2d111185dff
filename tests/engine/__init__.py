"""Tests of the C core and of the public network, each behaviour on both engines."""
