#include "cli/commands.h"
namespace mcdem { void add_table(CLI::App&, int&) {} }
