/* The loops of noise for one instruction set; CMakeLists.txt sets the flags. */
#define WR_NOISE_TABLE wr_noise_kernels_v4
#define WR_NOISE_NAME "v4"
#include "noise/octave_kernels_body.h"
