"""The paper reproduced: what it prints, what is computed now, and what the difference means."""
