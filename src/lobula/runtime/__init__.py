"""The live loop: frames in, readings to the outputs, events with a start and an end, exactly one summary."""
