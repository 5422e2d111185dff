"""The four spiking neurons: integration, sigmoid, adaptation, spikes."""
