"""python3 -m mcdem WORD ..: the commands of commands/, with the streams, signals and exit codes of the program."""
import sys

from mcdem.program import main

sys.argv[1:1] = ["mcdem.run_command"]
sys.exit(main())
