"""One contact of a mass under a law, first touch to release, as arrays of drops."""
