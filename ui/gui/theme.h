/* theme.h - the window's colours (0xAARRGGBB, sRGB) and sizes (pixels at scale 1).
   A neutral grey surround, so that greys are judged rightly, and one accent. Raise is warm and lower is
   cool, everywhere. */
#pragma once
#include <stdint.h>

typedef uint32_t WrColour; /* 0xAARRGGBB */

#define WR_COLOUR_SURROUND 0xff323232u /* behind the table and the patch */
#define WR_COLOUR_BAR 0xff262626u      /* menu, option row, status line */
#define WR_COLOUR_PANEL 0xff2c2c2cu
#define WR_COLOUR_FIELD 0xff1f1f1fu
#define WR_COLOUR_EDGE 0xff3a3a3au
#define WR_COLOUR_TEXT 0xffd6d6d6u
#define WR_COLOUR_LABEL 0xffa8a8a8u
#define WR_COLOUR_STRONG 0xfff0f0f0u
#define WR_COLOUR_ACCENT 0xff4a8fdcu
#define WR_COLOUR_SELECTED 0xff3f6fa8u
#define WR_COLOUR_FILL 0xff3a6290u /* the part of a slider's field below its value */
#define WR_COLOUR_RAISE 0xffc7772eu
#define WR_COLOUR_LOWER 0xff2e86b8u
#define WR_COLOUR_LEVEL 0xff6f7a86u /* mode `to` */
#define WR_COLOUR_CELL 0xffe8a25cu  /* outline of the real cell */
#define WR_COLOUR_CHIP 0xe0202020u  /* labels that lie on the canvas or the patch */
#define WR_COLOUR_BAD 0xffe0694fu   /* a message that something failed */
#define WR_COLOUR_LINE 0xff1a1a1au  /* between bars and views */
#define WR_COLOUR_LIGHT 0xffffd873u /* the light on the patch */
