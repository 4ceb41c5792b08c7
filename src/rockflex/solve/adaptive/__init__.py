"""The adaptive engine: Runge-Kutta steps with dense output, restarted at every sample and event."""
