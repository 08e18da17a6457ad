#include "challenge/answer.h"

namespace mcdem::inline challenge {

Answer answer_of(const Findings& findings, const Limits& limits) {
    const Decision decision = decide(findings, limits);
    Answer answer{decision.verdict, {}, 0};
    if (!answer.names()) return answer;
    for (const std::size_t candidate : decision.group) answer.group.push_back(findings.names[candidate]);
    answer.confidence = decision.confidence[decision.group.front()];
    return answer;
}

}  // namespace mcdem::challenge
