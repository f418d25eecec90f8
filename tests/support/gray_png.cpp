// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/gray_png.h"

#include <png.h>

#include <cstdio>
#include <stdexcept>

namespace opp::test {

void writeGrayPng(const std::filesystem::path& path, int width, int height,
                  const std::vector<std::uint16_t>& pixels, int bits) {
  std::vector<png_byte> bytes;
  for (const std::uint16_t pixel : pixels) {
    if (bits == 16) bytes.push_back(static_cast<png_byte>(pixel >> 8));
    bytes.push_back(static_cast<png_byte>(pixel & 0xff));
  }
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) throw std::runtime_error("cannot write " + path.string());
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const auto row_bytes = static_cast<std::size_t>(width * bits / 8);
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row) {
    png_write_row(png, bytes.data() + row * row_bytes);
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

}  // namespace opp::test
