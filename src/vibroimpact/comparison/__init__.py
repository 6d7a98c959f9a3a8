"""One case under several contact laws, side by side."""
