// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "report/base64.h"

#include <openssl/evp.h>

#include <algorithm>

namespace opp::mapping {

std::string base64(std::string_view bytes) {
  constexpr std::size_t kChunk = 3U << 20U;  // OpenSSL counts in int; whole triples need no padding
  std::string text;
  text.resize(4 * ((bytes.size() + 2) / 3) + 1);  // OpenSSL ends what it writes with a zero
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < bytes.size(); begin += kChunk) {
    const auto* input = reinterpret_cast<const unsigned char*>(bytes.data() + begin);
    const int length = static_cast<int>(std::min(kChunk, bytes.size() - begin));
    auto* output = reinterpret_cast<unsigned char*>(text.data() + end);
    end += static_cast<std::size_t>(EVP_EncodeBlock(output, input, length));
  }
  text.resize(end);
  return text;
}

}  // namespace opp::mapping
