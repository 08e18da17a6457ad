#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiment/import_tables.h"

namespace mcdem {
namespace {

struct Grain {
    long id;
    Vec3 position;    ///< [m]
    double diameter;  ///< [m]
    RowAt row;
};

/// The grains of one frame after another.
class GrainReader {
public:
    GrainReader(GrainFrames& frames, ExperimentProblems& problems) : frames_(frames), problems_(problems) {}

    void read(const ImportTable& table) {
        const MappedTable& map = table.map;
        const Rows rows(table, problems_);
        const bool radii = rows.has_column("radius");
        for (const char* key : {"x", "y", "z", radii ? "radius" : "diameter"})
            if (!rows.has_column(key))
                return problems_.add(
                    map.files.front(),
                    fmt::format("must have a column for {}, got none: name it in the mapping", key));
        const double unit = length_factor(map.word("length_unit", "m"));
        const Vec3 origin(number_entry(map, "origin_x"), number_entry(map, "origin_y"),
                          number_entry(map, "origin_z"));
        frames_.sign = {sign(map, "x"), sign(map, "y"), sign(map, "z")};
        const Vec3 begin = frames_.sign.cwiseProduct(origin);
        frames_.origin = unit * begin;
        const long first = whole_entry(map, "first_grain", problems_);
        if (rows.all().empty())
            return problems_.add(
                map.files.front(),
                "must have rows, one for each grain of a frame: leave a table without any out");
        double key = 0;
        by_place_ = !rows.has_column("grain");
        for (const RowAt& row : rows.all()) {
            if (!grains_.empty() && row.key != key) end_frame(key);
            key = row.key;
            const auto x = rows.number(row, "x"), y = rows.number(row, "y"), z = rows.number(row, "z"),
                       size = rows.number(row, radii ? "radius" : "diameter");
            const auto id = rows.has_column("grain") ? rows.whole_number(row, "grain")
                                                     : first + static_cast<long>(grains_.size());
            if (size && !(*size > 0))
                rows.problem_once(
                    "size", row, fmt::format("{} must be > 0, got {}", radii ? "radius" : "diameter", *size));
            if (x && y && z && size && id)
                grains_.push_back(
                    {*id, unit * (Vec3(*x, *y, *z) - begin), (radii ? 2 : 1) * unit * *size, row});
        }
        if (!grains_.empty()) end_frame(key);
    }

private:
    static double sign(const MappedTable& map, std::string_view key) {
        return signed_column(map.word(key, "")).sign;
    }

    void problem(const RowAt& row, const std::string& what) { add_problem(problems_, row, what); }

    void end_frame(double key) {
        std::ranges::stable_sort(grains_, {}, &Grain::id);
        for (std::size_t i = 1; i < grains_.size(); ++i)
            if (grains_[i].id == grains_[i - 1].id)
                add_problem_once(
                    problems_, "twice", grains_[i].row,
                    fmt::format(
                        "each grain must be there once in frame {}, got {} again: see frame in the mapping",
                        key, grains_[i].id));
        if (!used_.insert(key).second)
            problem(
                grains_.front().row,
                fmt::format("the rows of frame {} must follow one another, got more behind others: sort them",
                            key));
        if (frames_.keys.empty())
            for (const Grain& grain : grains_) {
                frames_.number_of.emplace(grain.id, static_cast<int>(frames_.diameter.size()));
                frames_.diameter.push_back(grain.diameter);
            }
        else {
            expect_all(key);
            if (by_place_ && grains_.size() == frames_.diameter.size()) expect_diameters(key);
        }
        frames_.keys.push_back(key);
        frames_.first_row.push_back(grains_.front().row);
        auto& position = frames_.position.emplace_back();
        for (const Grain& grain : grains_) position.push_back(grain.position);
        grains_.clear();
    }

    void expect_all(double key) {
        std::size_t missing = frames_.number_of.size();
        for (const Grain& grain : grains_) missing -= frames_.number_of.count(grain.id);
        if (missing > 0 || grains_.size() != frames_.number_of.size())
            add_problem_once(
                problems_, "all", grains_.front().row,
                fmt::format("frame {} must list the {} grains of the first frame, got {}, of which {} are "
                            "other ones: "
                            "number grains alike in all frames, and leave a frame out where one is missing",
                            key, frames_.number_of.size(), grains_.size(),
                            grains_.size() + missing - frames_.number_of.size()));
    }

    /// Without numbers, rows in another order show in their diameters. All may swell alike.
    void expect_diameters(double key) {
        double swelling = 0, differ = 0;
        const auto count = static_cast<double>(grains_.size());
        for (std::size_t i = 0; i < grains_.size(); ++i)
            swelling += grains_[i].diameter / frames_.diameter[i] / count;
        for (std::size_t i = 0; i < grains_.size(); ++i)
            differ += std::abs(grains_[i].diameter / frames_.diameter[i] / swelling - 1) / count;
        if (differ > 0.02)
            add_problem_once(
                problems_, "diameters", grains_.front().row,
                fmt::format("grains without numbers must stand in the same order in all frames, got "
                            "diameters in frame {} that differ by {:.0f} % from those of the first: "
                            "number the grains",
                            key, 100 * differ));
    }

    GrainFrames& frames_;
    ExperimentProblems& problems_;
    std::vector<Grain> grains_;
    bool by_place_ = false;  ///< rows count the grains
    std::set<double> used_;
};

}  // namespace

GrainFrames import_grains(const std::vector<const ImportTable*>& tables, ExperimentProblems& problems) {
    GrainFrames frames;
    GrainReader reader(frames, problems);
    for (const ImportTable* table : tables) reader.read(*table);
    frames.index = FrameIndex(frames.keys);
    return frames;
}

int GrainFrames::plate_row_of(std::string_view by, double key, std::size_t place) const {
    if (by == "order") return place < plate_rows ? static_cast<int>(place) : -1;
    if (by == "plate") return plate.find(key);
    const int frame = index.find(key);
    return frame < 0 || row.empty() ? -1 : row[static_cast<std::size_t>(frame)];
}

int GrainFrames::frame_of(std::string_view by, double key, std::size_t place) const {
    if (by == "grains" || (by == "plate" && row.empty())) return index.find(key);
    if (row.empty()) return place < keys.size() ? static_cast<int>(place) : -1;
    const int wanted = plate_row_of(by, key, place);
    const auto found = std::ranges::find(row, wanted);
    return wanted < 0 || found == row.end() ? -1 : static_cast<int>(found - row.begin());
}

double GrainFrames::top(std::size_t frame) const {
    double top = 0;
    for (std::size_t i = 0; i < diameter.size(); ++i)
        top = std::max(top, position[frame][i].z() + diameter[i] / 2);
    return top;
}

void place_frames(GrainFrames& grains, bool by_order, const PlateRows& plate) {
    grains.plate = plate.index;
    grains.plate_rows = plate.scans.size();
    grains.row.clear();
    for (std::size_t f = 0; f < grains.keys.size(); ++f)
        grains.row.push_back(grains.plate_row_of(by_order ? "order" : "plate", grains.keys[f], f));
}

}  // namespace mcdem
