"""The exact engine: states are advanced over whole samples in closed form; only event times are solved for."""
