/* oiio_tiff.hpp - direct calls of libtiff: write errors and tags that OpenImageIO does not report.
   C++, only in the module.
   Private to this module.

   libtiff reports failures on closing a file only to an error handler. OpenImageIO links libtiff; its
   few functions used here are declared in this file. */
#pragma once
extern "C" {
#include "system/fd.h"
}

#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

extern "C" void *TIFFSetErrorHandlerExt(void (*handler)(void *, const char *, const char *,
                                                        va_list)) __attribute__((weak));

/* The first error of this thread since the buffer was cleared, and errno before it. */
inline thread_local char tiff_error[256];
inline thread_local int tiff_errno;

inline void forget_tiff_error()
{
    tiff_error[0] = '\0';
    tiff_errno = errno = 0;
}

/* An unsupported tag was omitted intentionally (forbid_date), or is irrelevant. */
inline void on_tiff_error(void *, const char *from, const char *format, va_list list)
{
    if (from && std::strstr(from, "SetField")) return;
    bool disk = errno == EFBIG || errno == ENOSPC || errno == EDQUOT || errno == EIO;
    if (!tiff_errno && disk) tiff_errno = errno;
    if (!tiff_error[0]) vsnprintf(tiff_error, sizeof tiff_error, format, list);
}

inline void listen_to_tiff()
{
    if (TIFFSetErrorHandlerExt) TIFFSetErrorHandlerExt(on_tiff_error);
}

/* libtiff is loaded with OpenImageIO; three functions do not justify requiring its headers. */
extern "C" {
struct tiff;
struct tiff *TIFFFdOpen(int fd, const char *name, const char *mode) __attribute__((weak));
int TIFFSetDirectory(struct tiff *file, uint32_t directory) __attribute__((weak));
int TIFFGetField(struct tiff *file, uint32_t tag, ...) __attribute__((weak));
void TIFFClose(struct tiff *file) __attribute__((weak));
}

#define TIFF_GDAL_METADATA 42112U /* XML */
#define TIFF_GDAL_NODATA 42113U   /* a number as text */
#define TIFF_MODEL_PIXEL_SCALE 33550U
#define TIFF_MODEL_TRANSFORMATION 34264U

/* A number of GDAL's metadata for the first channel, "scale" or "offset", or the fallback. */
inline double gdal_number(const std::string &metadata, const char *role, double fallback)
{
    const std::string begin = std::string("sample=\"0\" role=\"") + role + "\">";
    const size_t at = metadata.find(begin);
    if (at == std::string::npos) return fallback;
    const char *from = metadata.c_str() + at + begin.size();
    char *end = nullptr;
    const double value = std::strtod(from, &end);
    return end != from && std::isfinite(value) ? value : fallback;
}

/* GDAL's no-data value and metadata of a directory, "" if absent. Returns true if the directory is georeferenced or
   has that value: its numbers are measurements. */
inline bool tiff_no_data(int fd, int directory, std::string &text, std::string &metadata)
{
    if (!TIFFFdOpen || !TIFFSetDirectory || !TIFFGetField || !TIFFClose) return false;
    /* A copy shares its position with the original, which OpenImageIO reads. */
    const int64_t position = wr_fd_position(fd);
    int copy = wr_fd_copy(fd);
    if (copy < 0) return false;
    wr_fd_seek(copy, 0);
    struct tiff *file = TIFFFdOpen(copy, "picture", "r"); /* owns the copy */
    if (!file) {
        wr_fd_close(copy);
        wr_fd_seek(fd, position);
        return false;
    }
    bool measured = false;
    if (TIFFSetDirectory(file, static_cast<uint32_t>(directory))) {
        /* libtiff returns unknown tags with their count. */
        uint32_t count = 0;
        const char *found = nullptr;
        const void *numbers = nullptr;
        if (TIFFGetField(file, TIFF_GDAL_NODATA, &count, &found) && found && count > 0 &&
            count < 64) {
            text.assign(found, strnlen(found, count));
            measured = true;
        }
        if (TIFFGetField(file, TIFF_GDAL_METADATA, &count, &found) && found && count < 65536)
            metadata.assign(found, strnlen(found, count));
        if (TIFFGetField(file, TIFF_MODEL_PIXEL_SCALE, &count, &numbers) ||
            TIFFGetField(file, TIFF_MODEL_TRANSFORMATION, &count, &numbers))
            measured = true;
    }
    wr_fd_seek(fd, position);
    TIFFClose(file);
    return measured;
}
