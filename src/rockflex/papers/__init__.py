"""Publications whose numbers and figures the library reproduces, one package each."""
