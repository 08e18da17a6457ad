// Contacts that a table lists twice, in other frames than the grains, or by their sizes: right, or refused.
#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ImportContactsTest : public ImportTest {
protected:
    static bool is_pair(const Contact& contact) { return !is_wall(contact.partner); }
    void keep_pairs() {
        for (Scan& scan : truth_.scans)
            std::erase_if(scan.contacts, [](const Contact& c) { return is_wall(c.partner); });
    }
    /// The mapping of the laboratory's tables, its contacts with this entry.
    Mapping lab_mapping(const std::string& key, const std::string& word) {
        Mapping mapping = mapping_of(guess_tables(write_lab({}), known_));
        for (MappedTable& table : mapping.tables)
            if (table.role == Role::contacts) table.entries[key] = Guess{{word}, Sure::stated, "", 0};
        return mapping;
    }
    /// Problems with the contacts of a recording, each listed from either side.
    std::vector<std::string> problems_with(const Recording& listed, const Mapping& mapping) {
        write("kontakte.csv", lab_contacts(listed, {}));
        return problems_of([&] { import_tables(read_import_tables(mapping), known_); });
    }
    /// Each pair a second time, changed so.
    template <class Change>
    Recording with_each_pair_again(const Change& change) const {
        Recording all = truth_;
        for (std::size_t s = 0; s < all.scans.size(); ++s)
            for (const Contact& contact : truth_.scans[s].contacts)
                if (is_pair(contact)) all.scans[s].contacts.push_back(change(contact));
        return all;
    }
};

TEST_F(ImportContactsTest, ForcesOfTwoSidesMustBeOpposite) {
    const Mapping both = lab_mapping("sides", "both");
    const auto turned = [](double factor) {
        return [factor](Contact c) {
            std::swap(c.grain, c.partner);
            c.force *= factor;
            return c;
        };
    };
    EXPECT_THAT(problems_with(with_each_pair_again(turned(-1)), both), IsEmpty());
    EXPECT_THAT(problems_with(with_each_pair_again(turned(-0.7)), both), IsEmpty())
        << "errors of measurement";
    for (const double factor : {1.0, 0.0001, -0.45, -2.2})
        EXPECT_THAT(problems_with(with_each_pair_again(turned(factor)), both),
                    ElementsAre(HasSubstr("the forces of a contact's two sides must be opposite, got")))
            << factor;
    EXPECT_THAT(problems_with(with_each_pair_again(turned(-1)), lab_mapping("sides", "one")),
                ElementsAre(HasSubstr("got it from its other side too: write `sides = \"both\"`")));
}

TEST_F(ImportContactsTest, RowsOfTheSameDirectionAreNoSides) {
    for (const std::string sides : {"both", "one"})
        EXPECT_THAT(
            problems_with(with_each_pair_again([](Contact c) { return c; }), lab_mapping("sides", sides)),
            ElementsAre(HasSubstr("got it again in the same direction or in another table: make one "
                                  "row of rows of normal and tangential parts")));
}

TEST_F(ImportContactsTest, FramesWithoutContactsCountInTheOrder) {
    std::string text = "step;Nr;x;y;z;fx;fy;fz\n";
    for (Scan& scan : truth_.scans) {
        std::erase_if(scan.contacts, [](const Contact& c) { return c.partner != wall_partner(Wall::plate); });
        if (scan.frame % 2 == 0) scan.contacts.clear();
        std::vector<Contact> of_grain(36, Contact{0, 0, Vec3::Zero(), Vec3::Zero(), 0});
        for (const Contact& contact : scan.contacts)
            of_grain[static_cast<std::size_t>(contact.grain)] = contact;
        for (std::size_t i = 0; i < of_grain.size(); ++i) {
            const Vec3 &at = of_grain[i].point, &force = of_grain[i].force;
            text += fmt::format("{};{};{:.12g};{:.12g};{:.12g};{:.12g};{:.12g};{:.12g}\n", 100 + scan.frame,
                                i + 1, at.x(), at.y(), at.z(), force.x(), force.y(), force.z());
        }
    }
    const auto files = write_lab({});
    const Mapping rest = mapping_of(guess_tables({files[0], files[1]}, known_));
    const auto mapping = parse_mapping(
        mapping_text(rest) +
            fmt::format("[[table]]\nrole = \"contacts\"\nfiles = [\"{}\"]\nframe = \"step\"\n"
                        "frames_by = \"order\"\ngrain = \"Nr\"\npartner = \"plate\"\nwhere = \"fz\"\n"
                        "x = \"x\"\ny = \"y\"\nz = \"z\"\nfx = \"fx\"\nfy = \"fy\"\nfz = \"fz\"\n"
                        "force_on = \"grain\"\nlength_unit = \"m\"\nforce_unit = \"N\"\n",
                        write("plate_forces.csv", text)),
        "m");
    expect_truth(import_tables(read_import_tables(mapping), known_).experiment.recording);
}

TEST_F(ImportContactsTest, SizesTakeTheirDirectionFromTheirOwnFrame) {
    keep_pairs();
    auto files = write_lab({});
    std::string text = "frame,id1,id2,fn_N\n";
    for (const Scan& scan : truth_.scans)
        for (const Contact& c : scan.contacts)
            text += fmt::format("{},{},{},{:.12g}\n", scan.frame, c.grain + 1, c.partner + 1, c.force.norm());
    write("kontakte.csv", text);
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::contacts).word("frames_by", ""), "order") << "0, 1, .. beside half seconds";
    EXPECT_THAT(unclear(tables), IsEmpty());
    expect_truth(import_tables(tables, known_).experiment.recording);
}

}  // namespace
}  // namespace mcdem::test
