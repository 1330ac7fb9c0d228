"""Values of other packages: times and quantities of astropy, arrays and frames of pandas and xarray, expressions of SymPy, integrations by SciPy."""
