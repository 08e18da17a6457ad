#include "experiment/column_names.h"

#include <array>
#include <cctype>
#include <cmath>

namespace mcdem {
namespace {

struct Word {
    std::string_view key;    ///< of mapping_keys
    std::string_view names;  ///< bases of names, parted by blanks, one at either end
};

/// Names of z where it counts downwards.
constexpr std::string_view downward_words = " depth tiefe profondeur zdown zdownwards ";

// The first that fits counts.
constexpr Word plate_words[] = {
    {"frame", " frame scan image snapshot step timestep bild schritt state time t zeit temps iter "},
    {"cycle", " cycle zyklus ncycle cyclenumber "},
    {"phase", " phase direction richtung loading "},
    {"plate_z",
     " platez zplate plateheight height z gap plateposition position pos hoehe h platte top ztop topz lid "
     "piston "},
    {"displacement", " displacement disp stroke travel weg hub verschiebung compression "},
    {"top_force",
     " topforce force load f fz kraft last ftop forcez plateforce normalforce loadcell platefz fplate3 "},
};
constexpr Word grain_words[] = {
    {"frame", " frame scan image snapshot step timestep bild schritt state time t zeit temps iter "},
    {"grain",
     " grain id particle label index korn teilchen nr no number atom particleid grainid bead beadid "},
    {"x", " x xc cx posx xpos centroidx xcentroid centerx xcenter xu px positionx "},
    {"y", " y yc cy posy ypos centroidy ycentroid centery ycenter yu py positiony "},
    {"z", " z zc cz posz zpos centroidz zcentroid centerz zcenter zu pz positionz "},
    {"z", downward_words},
    {"diameter", " diameter d dia diam durchmesser diametre "},
    {"radius", " radius r rad radii halbmesser rayon "},
};
constexpr Word contact_words[] = {
    {"frame", " frame scan image snapshot step timestep bild schritt state time t zeit temps iter "},
    {"grain",
     " grain id1 i grain1 particle1 particlei p1 a graina idi korn1 teilchen1 atom1 patom1 ida part1 g1 i1 "},
    {"partner",
     " partner id2 j grain2 particle2 particlej p2 b grainb idj korn2 teilchen2 atom2 patom2 idb part2 g2 i2 "
     "neighbour "
     "neighbor nachbar other contactwith "},
    {"x", " x xc cx px contactx xcontact cpx pointx "},
    {"y", " y yc cy py contacty ycontact cpy pointy "},
    {"z", " z zc cz pz contactz zcontact cpz pointz "},
    {"z", downward_words},
    {"fx", " fx forcex xforce f1 kraftx ffx fcx "},
    {"fy", " fy forcey yforce f2 krafty ffy fcy "},
    {"fz", " fz forcez zforce f3 kraftz ffz fcz "},
    {"force", " force f forcemagnitude fn normalforce kraft fabs fmag forcenorm "},
};

constexpr std::pair<std::string_view, double> time_units[] = {
    {"s", 1}, {"sec", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}};

std::string_view without(std::string_view text, std::string_view set) {
    const auto first = text.find_first_not_of(set);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(set) - first + 1);
}

/// The unit in the words of length_factor and force_factor; empty where it is none.
std::string known_unit(std::string_view word) {
    for (const auto& [written, unit] : {std::pair<std::string_view, std::string_view>{"\xC2\xB5m", "um"},
                                        {"\xCE\xBCm", "um"},
                                        {"micron", "um"},
                                        {"\xC2\xB5N", "uN"},
                                        {"\xCE\xBCN", "uN"},
                                        {"g", "gf"},
                                        {"kg", "kgf"},
                                        {"gram", "gf"},
                                        {"newton", "N"},
                                        {"meter", "m"}})
        if (word == written) return std::string(unit);
    for (const auto& [time, seconds] : time_units)
        if (word == time) return std::string(word);
    return std::isnan(length_factor(word)) && std::isnan(force_factor(word)) ? "" : std::string(word);
}

/// Cuts the unit off: in brackets, behind a slash, behind " in " or an underscore.
std::string cut_unit(std::string_view& name, std::string& unknown) {
    if (name.size() > 2 && (name.back() == ']' || name.back() == ')')) {
        const auto open = name.find_last_of("[(");
        if (open != name.npos && open > 0) {
            const std::string_view inside = without(name.substr(open + 1, name.size() - open - 2), " \t");
            if (inside.find_first_of("0123456789") != inside.npos) return "";  // a number, as in c_force[1]
            name = name.substr(0, open);
            const std::string unit = known_unit(inside);
            if (unit.empty()) unknown = inside;
            return unit;
        }
    }
    for (const std::string_view mark : {" in ", "/", "_", " "}) {
        const auto at = name.rfind(mark);
        if (at == name.npos || at == 0) continue;
        const std::string unit = known_unit(without(name.substr(at + mark.size()), " \t"));
        if (unit.empty()) continue;
        name = name.substr(0, at);
        return unit;
    }
    return "";
}

std::string without_umlauts(std::string_view name) {
    std::string text(name);
    for (const auto& [from, to] : {std::pair<std::string_view, std::string_view>{"\xC3\xA4", "ae"},
                                   {"\xC3\xB6", "oe"},
                                   {"\xC3\xBC", "ue"},
                                   {"\xC3\x9F", "ss"},
                                   {"\xC3\x84", "ae"},
                                   {"\xC3\x96", "oe"},
                                   {"\xC3\x9C", "ue"}})
        for (auto at = text.find(from); at != text.npos; at = text.find(from)) text.replace(at, 2, to);
    return text;
}

std::span<const Word> words_of(Role role) {
    switch (role) {
        case Role::plate:
            return plate_words;
        case Role::grains:
            return grain_words;
        case Role::contacts:
            return contact_words;
        case Role::aside:
            return {};
    }
    return {};
}

}  // namespace

double time_factor(std::string_view unit) {
    for (const auto& [word, seconds] : time_units)
        if (word == unit) return seconds;
    return std::nan("");
}

ColumnName column_name(std::string_view name) {
    ColumnName all;
    name = without(name, " \t");
    all.unit = cut_unit(name, all.unknown);
    const std::string folded = without_umlauts(name);
    for (const char c : folded)
        if (std::isalnum(static_cast<unsigned char>(c)))
            all.base += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return all;
}

bool is_among(const std::string& base, std::string_view names) {
    return !base.empty() && names.find(" " + base + " ") != names.npos;
}

std::optional<std::string_view> key_of_name(Role role, const ColumnName& name) {
    for (const Word& word : words_of(role))
        if (is_among(name.base, word.names)) return word.key;
    return std::nullopt;
}

bool names_downwards(const ColumnName& name) { return is_among(name.base, downward_words); }

}  // namespace mcdem
