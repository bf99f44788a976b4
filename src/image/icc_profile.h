/* icc_profile.h - the sRGB ICC profile, embedded in files for programs that prompt for a profile if
   there is none. */
#pragma once
#include <stddef.h>
#include <stdint.h>

#define WR_SRGB_PROFILE_SIZE 496 /* bytes */

/* A matrix/TRC display profile, version 4.2: the primaries of IEC 61966-2-1 adapted to D50, its curve
 * as a formula. Always the same bytes. Source: ICC.1:2004-10. */
void wr_srgb_profile(uint8_t out[WR_SRGB_PROFILE_SIZE]);
