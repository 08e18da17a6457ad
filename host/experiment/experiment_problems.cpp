#include "experiment/experiment_problems.h"

#include "core/errors.h"

namespace mcdem::inline experiment {
namespace {
constexpr std::size_t max_reported = 20;
}

bool ExperimentProblems::full() const { return first_.size() >= max_reported; }

void ExperimentProblems::add(const std::string& where, const std::string& what) {
    if (!full()) first_.push_back(where + ": " + what);
    ++count_;
}

void ExperimentProblems::add_once(const std::string& topic, const std::string& where,
                                  const std::string& what) {
    if (told_.insert(topic).second) add(where, what);
}

std::vector<std::string> ExperimentProblems::lines() const {
    auto problems = first_;
    const long more = count_ - static_cast<long>(first_.size());
    if (more > 0) problems.push_back(".. and " + std::to_string(more) + " more");
    return problems;
}

void ExperimentProblems::report() const {
    if (!empty()) throw InputError(lines());
}

}  // namespace mcdem::experiment
