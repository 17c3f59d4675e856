"""The figures, one module per family. Each function draws a Group of runs or raises LeftOut with the reason."""
