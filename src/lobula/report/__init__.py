"""Sinks that draw: the trace, the annotated video, the plots and the report page."""
