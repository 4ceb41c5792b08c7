"""The exact engine: states are carried across whole samples in closed form; only event times are solved for."""
