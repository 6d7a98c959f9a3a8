"""The live page: a case that is computed again at every change, in the browser."""
