"""Publications whose numbers and figures the library computes anew, one package each."""
