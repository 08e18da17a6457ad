// Box lines in files of packings: reading, and comparing with the container of a scene.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing/file_packing.h"
#include "scene/read/problems.h"

namespace mcdem::inline scene {

/// The box of one frame of a dump. `title` is that of the section: "BOX BOUNDS pp pp ff", with "xy xz yz" or
/// "abc origin" before the boundaries of tilted ones; `rows` are the three lines below, `line` the number of
/// the first. https://docs.lammps.org/dump.html
std::optional<StatedBox> dump_box(std::string_view title, const std::vector<std::string_view>& rows,
                                  long line, const std::string& source, FileProblems& problems);

/// Collects the box lines in the header of a data file: `xlo xhi` .., `xy xz yz`, or `avec` ..,
/// `abc origin`. https://docs.lammps.org/read_data.html
class DataBox {
public:
    /// False if the line does not belong to a box.
    bool read(const std::vector<std::string_view>& words, long line, FileProblems& problems);
    /// Nothing if a line is missing.
    std::optional<StatedBox> box(const std::string& source, FileProblems& problems) const;

private:
    std::array<std::optional<std::array<double, 2>>, 3> bounds_;
    std::array<double, 3> tilts_{};
    std::array<std::optional<Vec3>, 4> edges_;  ///< a, b, c and origin of a general triclinic box
    long line_ = 0;                             ///< the first of its lines
};

/// What contradicts the container of a scene, and what may: the latter is for the user to judge.
struct BoxFindings {
    std::vector<std::string> problems, warnings;
};

/// The box in the file of a packing, if any, against the container of the scene. Problems: a period, a tilt
/// or a corner that the container does not have; grains that reach through a periodic face where the
/// container has a wall. A box around walls may be larger than the container.
BoxFindings compare_box(const Packing& packing, const std::optional<StatedBox>& box, const Box& container);

}  // namespace mcdem::scene
