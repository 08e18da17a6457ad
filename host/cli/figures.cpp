#include "cli/commands.h"
namespace mcdem { void add_figures(CLI::App&, int&) {} }
