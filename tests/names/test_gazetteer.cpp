#include <chrono>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/paths.h"
#include "names/summit_list.h"

// Names that Relevo brings (data/README.md): found, ranked, where they are, and in time.
namespace relevo::names {
namespace {

using geo::geodetic_deg;
using testing::ElementsAre, testing::IsEmpty, testing::HasSubstr, testing::Not;

std::vector<std::string> names_of(const std::vector<const Entry*>& entries) {
    std::vector<std::string> names;
    for (const Entry* const entry : entries)
        names.push_back(fmt::format("{} {}", entry->name, entry->country));
    return names;
}

std::vector<std::string> found(const char* text, const std::optional<Near>& near = {},
                               std::size_t most = 3) {
    return names_of(Gazetteer::shipped().find(text, near, most));
}

Near at(double lat_deg, double lon_deg, double radius_m = 50e3) {
    return {geodetic_deg(lat_deg, lon_deg), radius_m};
}

TEST(Gazetteer, FindsNamesHoweverTheyAreTyped) {
    EXPECT_THAT(found("Innsbruck", {}, 1), ElementsAre("Innsbruck AT"));
    EXPECT_THAT(found("innsbruck", {}, 1), ElementsAre("Innsbruck AT"));
    EXPECT_THAT(found("sao tome", {}, 1), ElementsAre("São Tomé ST"));
    EXPECT_THAT(found("munich", {}, 1), ElementsAre("Munich DE"));
    EXPECT_THAT(found("MÜNCHEN", {}, 1), ElementsAre("Munich DE"));
    EXPECT_THAT(found("muenchen", {}, 1), ElementsAre("Munich DE"));
    EXPECT_THAT(found("großglockner", {}, 1), ElementsAre("Grossglockner AT"));
    EXPECT_THAT(found("glockn"), IsEmpty());  // within a word
    EXPECT_THAT(found("xyzzy"), IsEmpty());
    EXPECT_THAT(found(""), IsEmpty());
    EXPECT_THAT(found(" '"), IsEmpty());
    EXPECT_THAT(found("\xff\xfe"), IsEmpty());
    EXPECT_THAT(found("\n"), IsEmpty());
    EXPECT_THAT(found("Innsbruck", {}, 0), IsEmpty());
}

TEST(Gazetteer, FindsOtherScripts) {
    const std::vector<const Entry*> all = Gazetteer::shipped().find("a", {}, 1000000);
    EXPECT_GT(all.size(), 10000u);
    for (const char* const text : {"富士山", "مكة", "Όλυμπος", "Эверест"})
        EXPECT_NO_THROW(found(text)) << text;
}

TEST(Gazetteer, RanksByFitAndSize) {
    // The whole name first, then names that begin so, then later words; the largest of each.
    EXPECT_THAT(found("paris", {}, 2), ElementsAre("Paris FR", "Paris US"));
    EXPECT_THAT(found("york", {}, 1), ElementsAre("York GB"));
}

TEST(Gazetteer, RanksByDistanceNearADem) {
    EXPECT_THAT(found("nevis", at(56.8, -5), 1), ElementsAre("Ben Nevis GB"));
    EXPECT_THAT(found("paris", at(36.3, -88.3), 1), ElementsAre("Paris US"));
    EXPECT_THAT(found("paris", at(48, 3), 1), ElementsAre("Paris FR"));
    // On the DEM a later word is enough.
    EXPECT_THAT(found("york", at(40.7, -74), 1), ElementsAre("New York City US"));
    EXPECT_THAT(found("york", at(40.7, -74, 0), 1), ElementsAre("York US"));
    // The way over 180 degrees and over a pole is the short one.
    const auto over_180 = Gazetteer::shipped().find("suva", at(-17, -179), 1);
    EXPECT_THAT(names_of(over_180), ElementsAre("Suva FJ"));
    EXPECT_THAT(found("longyearbyen", at(90, 0), 1), ElementsAre("Longyearbyen SJ"));
}

TEST(Gazetteer, SummitsWithinADistance) {
    const auto around = Gazetteer::shipped().within(Kind::Summit, at(47.2, 11.4, 30e3));
    EXPECT_THAT(names_of(around), testing::IsSupersetOf({"Serles AT", "Patscherkofel AT"}));
    for (const Entry* const entry : around) {
        EXPECT_EQ(entry->kind, Kind::Summit);
        EXPECT_LT(geo::geodesic(geodetic_deg(47.2, 11.4), entry->place).distance_m, 30.4e3);
    }
    EXPECT_EQ(Gazetteer::shipped().within(Kind::Summit, at(0, 0, 21e6)).size(), 46356u);
    EXPECT_THAT(names_of(Gazetteer::shipped().within(Kind::Summit, at(0, -160, 1e5))), IsEmpty());
}

TEST(Gazetteer, TheNearestPlaceWithinADistance) {
    EXPECT_EQ(Gazetteer::shipped().nearest_place(at(47.2627, 11.3945, 50e3))->name, "Innsbruck");
    EXPECT_EQ(Gazetteer::shipped().nearest_place(at(0, -160, 1e5)), nullptr);
}

TEST(Gazetteer, HasPlacesWhereTheyAre) {
    const test::Csv truth = test::read_csv(test::source_dir() / "tests/names/truth.csv");
    const auto field = [&](const auto& row, const char* name) { return row[truth.column(name)]; };
    std::vector<double> places_km, summits_km;
    for (const auto& row : truth.rows) {
        const geo::Geodetic place =
            geodetic_deg(std::stod(field(row, "lat")), std::stod(field(row, "lon")));
        const std::string name = field(row, "our_name");
        const auto entries = Gazetteer::shipped().find(name, Near{place, 20e3}, 1);
        ASSERT_EQ(entries.size(), 1u) << name;
        const double km = geo::geodesic(place, entries[0]->place).distance_m / 1000;
        EXPECT_NEAR(km, std::stod(field(row, "err_km")), 0.04) << name;
        const bool is_summit = field(row, "kind") == "summit";
        EXPECT_EQ(entries[0]->kind, is_summit ? Kind::Summit : Kind::Place) << name;
        (is_summit ? summits_km : places_km).push_back(km);
        if (!is_summit) continue;
        EXPECT_EQ(std::string(1, entries[0]->source), field(row, "our_src")) << name;
        if (!field(row, "err_m").empty()) {
            EXPECT_NEAR(entries[0]->size.value_or(0), std::stod(field(row, "ele_m")), 2) << name;
        }
    }
    test::print_accuracy("places", places_km, "km", 5);
    test::print_accuracy("summits", summits_km, "km", 10);
}

TEST(Gazetteer, IsFast) {
    using Clock = std::chrono::steady_clock;
    const auto ms = [](Clock::duration time) {
        return std::chrono::duration<double, std::milli>(time).count();
    };
    const Clock::time_point begin = Clock::now();
    const Gazetteer gazetteer(share_dir() / "data/names/places.tsv.gz",
                              share_dir() / "data/names/summits.tsv.gz");
    std::string text =
        fmt::format("[ speed    ] read in {:.0f} ms; found in", ms(Clock::now() - begin));
    for (const char* const name : {"Innsbruck", "innsbruck", "sao tome", "a"}) {
        const Clock::time_point start = Clock::now();
        EXPECT_THAT(gazetteer.find(name, at(47, 11), 10), Not(IsEmpty()));
        text += fmt::format(" {:.1f} ms ({})", ms(Clock::now() - start), name);
    }
    fmt::print("{}\n", text);
}

const std::string kPlaces = "name\talt\tcc\tlat\tlon\tpop\n",
                  kSummits = "name\talt\tcc\tlat\tlon\tele\tsrc\n";

TEST(Gazetteer, RefusesFilesThatAreDamaged) {
    const auto good = test::packed("places", kPlaces + "A\tB|C\tAT\t1\t2\t3\n");
    const auto reads = [&](const std::filesystem::path& summits) {
        return test::error_of([&] { const Gazetteer read(good, summits); });
    };
    EXPECT_EQ(reads(test::packed("good", kSummits + "A\t\t\t1\t2\t\tN\n")), "no error");
    EXPECT_THAT(reads("/missing"), HasSubstr("names: /missing: cannot be read"));
    EXPECT_THAT(reads("/missing"), testing::EndsWith("; install Relevo again"));
    for (const char* const row :
         {"A\t\t\t91\t2\t\tN\n", "A\t\t\t1\tx\t\tN\n", "A\t\t\t1\t2\tx\tN\n", "A\t\t\t1\t2\t3\n",
          "\t\t\t1\t2\t3\tN\n", "A\t\t\t1\t2\t3\tNN\n", "A\t\t\t1\t2\t3\tN\t4\n", "\n"})
        EXPECT_THAT(reads(test::packed("row", kSummits + row)), HasSubstr("line 2: damaged"))
            << row;
    EXPECT_THAT(reads(good), HasSubstr("no such list of this version"));

    const auto cut = test::packed("cut", kSummits + "A\t\t\t1\t2\t\tN\n");
    std::filesystem::resize_file(cut, std::filesystem::file_size(cut) - 9);
    EXPECT_THAT(reads(cut), HasSubstr("not all of it is there"));
    std::ofstream(cut) << kSummits;  // not packed
    EXPECT_THAT(reads(cut), HasSubstr("damaged"));
    std::ofstream(cut, std::ios::trunc).flush();
    EXPECT_THAT(reads(cut), HasSubstr("not all of it is there"));
}

}  // namespace
}  // namespace relevo::names
