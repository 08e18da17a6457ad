// The table of scene keys. Reading, checking, defaults, parameters in results and the reference in
// scenes/README.md all use it. A new key needs one row, and a member in scene.h.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Everything that keys can set, before copies are made: the run, and one replica.
struct Settings {
    Settings() {
        run.slots = 0;
        replica.protocol.relax_time = replica.protocol.settle_time = not_given;
    }
    Scene run;  ///< its slots are 0 until they are known; the times of its replicas likewise not_given
    Replica replica;
    GeneratedPacking generated;
    std::string packing_file;  ///< empty: generated
    int packing_frame = -1;    ///< timestep of a dump; -1: the last one
    PackingReader packing_reader = read_packing;
    int copies = 1;
    double cylinder_radius = 0.0827;  ///< of a cylinder [m]; sets the sizes of its box
    double cell_height =
        not_given;  ///< of a cell [m]; sets the height of its box and plate.start, which is otherwise unused
};

/// The file of the packing; there must be one.
inline PackingFile packing_file_of(const Settings& settings) {
    const int frame = settings.packing_frame;
    return {settings.packing_file, frame < 0 ? std::nullopt : std::optional<long>(frame),
            settings.packing_reader};
}

/// Allowed range of a number.
struct Range {
    enum class Low { included, excluded };
    double low = 0;
    double high = 0;
    Low low_end = Low::included;
    int multiple_of = 1;
    bool contains(double value) const;
};

/// Location of a key's value.
template <class Value>
struct MemberOf {
    using Reach = Value& (*)(Settings& settings, std::size_t element);
    constexpr MemberOf(Reach reach) : reach(reach) {}
    Value& operator()(Settings& settings) const { return reach(settings, element); }

    Reach reach;
    std::size_t element =
        0;  ///< index of the table, for tables that a scene can have several of (scene/read/list_tables.h)
};
template <class... Values>
using MemberOfOne = std::variant<MemberOf<Values>...>;

/// The alternative determines the key's type.
using Member =
    MemberOfOne<double, int, std::uint64_t, bool, std::string, std::vector<double>, ContactModel, FrictionLaw,
                Precision, ContainerShape, StageKind, Controlled, SizeLaw, FractionsBy>;

/// Whether the replicas of a run may have different values.
enum class Scope { run, replica };

struct Key {
    std::string_view name;  ///< "grains.friction"
    Member member;
    std::string_view unit;  ///< empty for pure numbers and words
    Range range;            ///< of numbers
    Scope scope;
    std::string_view meaning;
};

/// All keys, except those of tables that a scene can have several of (scene/read/list_tables.h).
std::span<const Key> keys();

/// The keys of one stage of a programme, counted from 0: "programme.1.force".
std::span<const Key> stage_keys(int stage);

/// The key with this name, including those of stages and species, or null.
const Key* find_key(std::string_view name);

/// True for "grains", "packing" and the other tables of keys, including "batch.vary", "programme.1" and
/// "species.2".
bool is_table(std::string_view name);

/// The other name of the key box.size_x or box.size_y; null for other keys.
const Key* same_key(std::string_view name);

/// False for the sizes of other container shapes.
bool is_key_of(ContainerShape shape, std::string_view name);

/// The stage, from 0, in a name such as "programme.2" or "programme.2.force"; -1 if there is none.
int stage_of(std::string_view name);

/// True for the keys of a generated packing, which a packing file overrides.
bool is_generator_key(std::string_view name);

/// " (did you mean ..?)", or nothing if no key or table is similar.
std::string suggestion(std::string_view unknown);

/// "friction" of "grains.friction".
std::string_view last_part(std::string_view name);

/// Allowed values of the key: "a number > 0 and <= 10 [m]", "one of saturated, mindlin".
std::string description(const Key& key);

Parameter value_of(const Key& key, const Settings& settings);
std::string value_text(const Key& key, const Settings& settings);

/// Parameters from their text in a file. What is no value of its key, or has an unknown key, stays text.
Parameters parameters_of(const ParameterTexts& texts);

}  // namespace mcdem::scene
