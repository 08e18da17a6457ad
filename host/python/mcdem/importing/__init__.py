"""Imports tables of a laboratory or of another program as an experiment: guesses a mapping and reads the tables with it
(host/python/mcdem/experiment/README.md).

`mcdem experiment import` runs it by import_files: from files to named columns (tables, text, formats, joins), to what the columns are (names,
mapping, guess*), to frames in SI units (rows, plate, grains with links, contacts; course and record of a testing machine), to one experiment (assemble).
"""
