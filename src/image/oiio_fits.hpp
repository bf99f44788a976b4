/* oiio_fits.hpp - parser of FITS header numbers that OpenImageIO misreads. C++, only in the module.
   Private to this module.

   OpenImageIO stops at the D of a Fortran exponent (1.25D1), which the FITS standard 4.0, 4.2.4 allows. */
#pragma once
extern "C" {
#include "system/fd.h"
}

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#define FITS_BLOCK 2880 /* bytes; headers and data are padded to whole blocks */
#define FITS_CARD 80    /* bytes of a header line */

/* Offset of a picture's header, with OpenImageIO's numbering; -1: none. */
inline int64_t fits_header(int fd, int picture)
{
    char begin[20];
    for (int64_t at = 0; wr_fd_read_at(fd, begin, sizeof begin, at) == sizeof begin;
         at += FITS_BLOCK)
        if ((!std::memcmp(begin, "SIMPLE", 6) ||
             !std::memcmp(begin, "XTENSION= 'IMAGE   '", sizeof begin)) &&
            picture-- == 0)
            return at;
    return -1;
}

/* The number of a key in a picture's header, or the fallback if absent. */
inline double fits_number(int fd, int picture, const char *key, double fallback)
{
    char card[FITS_CARD + 1] = "", padded[12];
    std::snprintf(padded, sizeof padded, "%-8s= ", key);
    const int64_t begin = fits_header(fd, picture), most = begin + 1024 * FITS_BLOCK;
    for (int64_t at = begin; at >= 0 && at < most; at += FITS_CARD) {
        if (wr_fd_read_at(fd, card, FITS_CARD, at) != FITS_CARD ||
            !std::memcmp(card, "END     ", 8))
            break;
        if (std::memcmp(card, padded, 10) != 0) continue;
        std::string text(card + 10, strcspn(card + 10, "/"));
        for (char &letter : text)
            if (letter == 'D' || letter == 'd') letter = 'E';
        char *end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end != text.c_str() && std::isfinite(value) ? value : fallback;
    }
    return fallback;
}
