#include "cli/shell/cli.h"

int main(int argc, char** argv) { return mcdem::run_cli(argc, argv); }
