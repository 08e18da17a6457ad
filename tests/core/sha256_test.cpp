#include "core/sha256.h"

#include <gtest/gtest.h>

using mcdem::Sha256;

// The examples of FIPS 180-4.
TEST(Sha256, AgreesWithTheStandardsExamples) {
    EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(Sha256().add("abc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, AcceptsDataInPieces) {
    EXPECT_EQ(Sha256().add("a").add("bc").hex(), Sha256().add("abc").hex());
    const double numbers[] = {1.0, 2.0};
    EXPECT_NE(Sha256().add(numbers).hex(), Sha256().add(std::span(numbers).first(1)).hex());
}
