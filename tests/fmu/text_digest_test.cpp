// SPDX-License-Identifier: MIT
#include "fmu/text_digest.h"

#include <gtest/gtest.h>

#include <string>

namespace beamgyro::internal {
namespace {

// Examples of NIST for FIPS 180-4.
TEST(TextDigest, IsSha256) {
  EXPECT_EQ(text_digest(""),
            "e3b0c44298fc1c149afbf4c8996fb924"
            "27ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(text_digest("abc"),
            "ba7816bf8f01cfea414140de5dae2223"
            "b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(
      text_digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
      "248d6a61d20638b8e5c026930c3e6039"
      "a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(text_digest(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67"
            "f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace beamgyro::internal
