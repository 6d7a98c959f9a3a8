"""What sensors on the plate record: its motion through a measuring chain, as samples."""
