// SPDX-FileCopyrightText: 2026 The opp-mapping authors
// SPDX-License-Identifier: BSD-3-Clause
#include "opp/mapping/io/gray16_png.h"

#include <png.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>

namespace opp::mapping {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// libpng reports errors through this; it must not return.
[[noreturn]] void throwError(png_structp png, png_const_charp message) {
  auto* const text = static_cast<std::string*>(png_get_error_ptr(png));
  *text = message;
  png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// Owns libpng's reading state.
struct Reader {
  std::string error;
  png_structp png = nullptr;
  png_infop info = nullptr;

  Reader() : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, throwError, ignoreWarning)) {
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw std::runtime_error("libpng cannot be set up");
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// False on an error, then `error` says which. Holds no object with a destructor: libpng leaves
  /// it by longjmp.
  bool readHeader(std::FILE* file) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_init_io(png, file);
    png_read_info(png, info);
    return true;
  }
  bool readRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_swap(png);  // PNG is big-endian; the processors we build for are not
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
  }
};

}  // namespace

Gray16Image readGray16Png(const std::filesystem::path& path) {
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file || std::filesystem::is_directory(path)) {
    throw std::runtime_error(path.string() + ": cannot be opened as an image");
  }
  Reader reader;
  const auto fail = [&] {
    throw std::runtime_error(path.string() + ": is no readable PNG image: " + reader.error);
  };
  if (!reader.readHeader(file.get())) fail();
  if (png_get_bit_depth(reader.png, reader.info) != 16 ||
      png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY) {
    throw std::runtime_error(path.string() + ": depth must be a 16-bit grey image");
  }
  Gray16Image image;
  image.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  image.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  const auto width = static_cast<std::size_t>(image.width);
  image.pixels.resize(width * static_cast<std::size_t>(image.height));
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r] = reinterpret_cast<png_bytep>(image.pixels.data() + r * width);
  }
  if (!reader.readRows(rows.data())) fail();
  return image;
}

}  // namespace opp::mapping
