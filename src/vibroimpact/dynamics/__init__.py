"""The drop: flight, contact, release, the energy ledger and the response."""
