"""Contact laws: pure array functions of indentation, its rate and the speed at first touch."""
