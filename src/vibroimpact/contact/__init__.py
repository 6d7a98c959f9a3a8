"""Contact laws: forces as array functions of indentation, indentation rate and approach speed."""
