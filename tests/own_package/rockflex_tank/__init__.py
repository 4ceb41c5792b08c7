"""Water tanks that rock on flag-shaped bars."""
