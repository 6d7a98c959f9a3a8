"""Signal processing of records, whatever their source: onset, packets, features."""
