"""What every layer may use: errors, checks, numbers and units in text, values with arrays, files, JSON, languages."""
