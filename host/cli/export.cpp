#include "cli/commands.h"
namespace mcdem { void add_export(CLI::App&, int&) {} }
