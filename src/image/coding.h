/* coding.h - coding of unit vectors in a picture: as they are (signed), or with -1..1 stored as 0..1 (unit).

   Codes of 8 and 16 bits are always unit. Files of floats hold either. Without a choice the distribution decides: for each
   texel the distance of its length from 1 is taken both ways, at most 1 (of two channels, how much it is over 1); numbers
   below 0 by more than rounding count as a distance of 1 from unit. The smaller sum is taken, unit if both are equal. So a
   blue of 1.00001, as bakes in floats have, or a few numbers below 0 by a filter's overshoot, decide nothing. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;

#define WR_CODINGS(X)                                                                              \
    X(WR_CODING_AUTO, "auto") X(WR_CODING_UNIT, "unit") X(WR_CODING_SIGNED, "signed")
typedef enum WrCoding { WR_CODINGS(WR_WORD_ID) WR_CODING_COUNT } WrCoding;
extern const char *const wr_codings[]; /* as in commands; ends with NULL */

/* WR_CODING_UNIT or WR_CODING_SIGNED for the first `channels` (2 or 3) numbers of a texel in *found. False and an error for
 * signed where the file holds codes, or when the work was cancelled. */
bool wr_coding_find(const WrImage *image, int channels, WrCoding wanted, WrCoding *found,
                    WrError *err);
