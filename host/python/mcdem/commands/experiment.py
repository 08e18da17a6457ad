"""mcdem experiment: the commands experiment check, import and from-run."""

EPILOG = """\
An experiment's folder is described in host/python/mcdem/experiment/README.md.
Examples:
  mcdem experiment import data/plate.txt data/grains.txt --set 'box.size=[0.165, 0.166]' --out out/lab
  mcdem experiment check out/lab
  mcdem experiment from-run out/begun --replica mc_dem --out out/measured"""
