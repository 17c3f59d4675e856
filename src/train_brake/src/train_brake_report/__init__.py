"""The report on one or several runs of the train: a self-contained HTML page and its figures. Start: command.py."""
