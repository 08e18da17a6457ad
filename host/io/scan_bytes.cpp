#include "io/scan_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/errors.h"
#include "io/result_rows.h"

namespace mcdem::inline io {
namespace {

using ContactBytes = ContactRow<double>;

class BytesOut {
public:
    explicit BytesOut(std::vector<std::byte>& bytes) : bytes_(bytes) {}
    template <class Value>
    void put(const Value& value) {
        put_all(&value, 1);
    }
    template <class Values>
    void put_list(const Values& values) {
        put(static_cast<std::uint64_t>(values.size()));
        put_all(values.data(), values.size());
    }

private:
    template <class Value>
    void put_all(const Value* values, std::size_t count) {
        const auto* begin = reinterpret_cast<const std::byte*>(values);
        bytes_.insert(bytes_.end(), begin, begin + count * sizeof(Value));
    }
    std::vector<std::byte>& bytes_;
};

/// Reads never pass the end, whatever counts the bytes claim.
class BytesIn {
public:
    BytesIn(const std::vector<std::byte>& bytes, const std::string& where) : bytes_(bytes), where_(where) {}
    template <class Value>
    Value take() {
        Value value;
        take_all(&value, 1);
        return value;
    }
    template <class Values>
    Values take_list() {
        Values values;
        const std::uint64_t count = take<std::uint64_t>();
        if (count > (bytes_.size() - place_) / sizeof(values[0])) refuse("ends early");
        values.resize(count);
        take_all(values.data(), values.size());
        return values;
    }
    bool at_end() const { return place_ == bytes_.size(); }
    [[noreturn]] void refuse(const std::string& problem) const {
        throw InputError(fmt::format("{}: the scans in it cannot be read: {}", where_, problem));
    }

private:
    template <class Value>
    void take_all(Value* values, std::size_t count) {
        if (count > (bytes_.size() - place_) / sizeof(Value)) refuse("ends early");
        if (count > 0) std::memcpy(static_cast<void*>(values), bytes_.data() + place_, count * sizeof(Value));
        place_ += count * sizeof(Value);
    }
    const std::vector<std::byte>& bytes_;
    const std::string& where_;
    std::size_t place_ = 0;
};

void put_scan(BytesOut& out, const Scan& scan) {
    out.put(scan_row(scan));
    out.put_list(scan.position);
    out.put_list(scan.rotation);
    std::vector<ContactBytes> contacts;
    for (const Contact& contact : scan.contacts) contacts.push_back(contact_row<double>(contact));
    out.put_list(contacts);
}

std::vector<Vec3> take_vectors(BytesIn& in, std::size_t grains) {
    auto vectors = in.take_list<std::vector<Vec3>>();
    if (!vectors.empty() && vectors.size() != grains)
        in.refuse(fmt::format("{} positions or rotations for {} grains", vectors.size(), grains));
    if (!std::ranges::all_of(vectors, [](const Vec3& vector) { return vector.allFinite(); }))
        in.refuse("a position or rotation is no number");
    return vectors;
}

Scan take_scan(BytesIn& in, std::size_t grains, const std::string& where) {
    Scan scan = scan_of(in.take<ScanRow>(), where);
    scan.position = take_vectors(in, grains);
    scan.rotation = take_vectors(in, grains);
    for (const auto& row : in.take_list<std::vector<ContactBytes>>())
        scan.contacts.push_back(contact_of(row, grains, where));
    return scan;
}

}  // namespace

std::vector<std::byte> scan_bytes(const std::vector<Recording>& recordings) {
    std::vector<std::byte> bytes;
    BytesOut out(bytes);
    for (const Recording& recording : recordings) {
        out.put(static_cast<std::uint64_t>(recording.scans.size()));
        for (const Scan& scan : recording.scans) put_scan(out, scan);
        out.put(static_cast<std::uint64_t>(recording.failure.has_value()));
        if (!recording.failure) continue;
        out.put(recording.failure->step);
        out.put(recording.failure->grain);
        out.put_list(recording.failure->cause);
    }
    return bytes;
}

void add_scans(const std::vector<std::byte>& bytes, std::vector<Recording>& recordings,
               const std::string& where) {
    BytesIn in(bytes, where);
    for (Recording& recording : recordings) {
        const auto scans = in.take<std::uint64_t>();
        for (std::uint64_t s = 0; s < scans; ++s)
            recording.scans.push_back(take_scan(in, recording.diameter.size(), where));
        if (in.take<std::uint64_t>() == 0) continue;
        Failure failure;
        failure.step = in.take<long>();
        failure.grain = in.take<int>();
        failure.cause = in.take_list<std::string>();
        recording.failure = std::move(failure);
    }
    if (!in.at_end()) in.refuse("there are more than this scene has replicas");
}

}  // namespace mcdem::io
