// SPDX-License-Identifier: MIT
#include "dataset/files/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "dataset/files/text_file.h"

namespace beamgyro::internal {
namespace {

void check(int answer) {
  if (answer != 1) throw std::runtime_error("cannot compute SHA-256");
}

}  // namespace

struct Sha256::State {
  State() { check(EVP_DigestInit_ex(context, EVP_sha256(), nullptr)); }
  ~State() { EVP_MD_CTX_free(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  EVP_MD_CTX* context = EVP_MD_CTX_new();
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;

void Sha256::add(std::span<const std::byte> bytes) {
  check(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()));
}

std::string Sha256::digits() {
  std::array<unsigned char, 32> hash{};
  check(EVP_DigestFinal_ex(state_->context, hash.data(), nullptr));
  return fmt::format("{:02x}", fmt::join(hash, ""));
}

std::string sha256(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digits();
}

std::string sha256(std::string_view bytes) {
  return sha256(std::as_bytes(std::span(bytes)));
}

std::string sha256_of_file(const std::filesystem::path& path) {
  Sha256 hash;
  read_in_pieces(path, [&](std::string_view piece) {
    hash.add(std::as_bytes(std::span(piece)));
  });
  return hash.digits();
}

std::string sha256_of_rest(OpenFile& file,
                           const std::function<void(std::size_t)>& on_piece) {
  Sha256 hash;
  file.read_pieces([&](std::span<const std::byte> piece) {
    hash.add(piece);
    if (on_piece) on_piece(piece.size());
  });
  return hash.digits();
}

}  // namespace beamgyro::internal
