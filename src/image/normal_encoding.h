/* normal_encoding.h - coding of unit vectors in an image: signed, or unit (-1..1 stored as 0..1).

   Codes of 8 and 16 bits are always unit. Float files contain either. Without a choice the texels
   decide: for each texel the distance of its length from 1 is computed for both codings, at most 1 (for
   two channels, the excess over 1); numbers below 0 by more than rounding count as a distance of 1 from
   unit. The smaller sum wins, unit if both are equal. So a blue of 1.00001, as in float bakes, or a few
   negative numbers from a filter's overshoot, do not affect the result. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

#define WR_CODINGS(X)                                                                              \
    X(WR_CODING_AUTO, "auto") X(WR_CODING_UNIT, "unit") X(WR_CODING_SIGNED, "signed")
typedef enum WrCoding { WR_CODINGS(WR_WORD_ID) WR_CODING_COUNT } WrCoding;
extern const char *const wr_codings[]; /* as in commands; ends with NULL */

/* Stores WR_CODING_UNIT or WR_CODING_SIGNED for the first `channels` (2 or 3) numbers of a texel in
 * *found. False and an error if signed is requested for integer codes, or when cancelled. */
bool wr_coding_find(const WrImage *image, int channels, WrCoding wanted, WrCoding *found,
                    WrError *err);

/* ---- ICC profiles ---- */

/* The sRGB ICC profile, embedded in files for programs that prompt for a profile if
   there is none. */

#define WR_SRGB_PROFILE_SIZE 496 /* bytes */

/* A matrix/TRC display profile, version 4.2: the primaries of IEC 61966-2-1 adapted to D50, its curve
 * as a formula. Always the same bytes. Source: ICC.1:2004-10. */
void wr_srgb_profile(uint8_t out[WR_SRGB_PROFILE_SIZE]);
