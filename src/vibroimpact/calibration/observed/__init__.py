"""What a calibration is held to: observations of impacts, with their noise and inputs."""
