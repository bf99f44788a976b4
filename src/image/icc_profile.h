/* icc_profile.h - the ICC profile of sRGB, for files of programs that ask which one is meant where none is there. */
#pragma once
#include <stddef.h>
#include <stdint.h>

#define WR_SRGB_PROFILE_SIZE 496 /* bytes */

/* A matrix/TRC display profile, version 4.2: the primaries of IEC 61966-2-1 adapted to D50, its curve as a
 * formula. The same bytes each time. Source: ICC.1:2004-10. */
void wr_srgb_profile(uint8_t out[WR_SRGB_PROFILE_SIZE]);
