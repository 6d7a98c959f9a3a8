"""The result of one simulated drop as plain data, and the result folder that stores it."""
