/* background.h - background of 8-bit pictures and of the window: a colour, a vertical gradient, the
   surroundings, or none.

   Float pictures contain coverage instead. Colours are linear RGB. */
#pragma once
#include <stdbool.h>

typedef enum WrBackgroundKind {
    WR_BACKGROUND_PLAIN,    /* `top` everywhere */
    WR_BACKGROUND_GRADIENT, /* from `top` to `bottom` */
    WR_BACKGROUND_NONE,     /* transparent in pictures with alpha; others: `top` everywhere */
    /* the scene's surroundings from the camera; if there are none: `top` everywhere */
    WR_BACKGROUND_SURROUNDINGS,
    WR_BACKGROUND_KINDS
} WrBackgroundKind;
/* As in commands: "plain", "gradient", "none", "surroundings". */
extern const char *const wr_background_names[WR_BACKGROUND_KINDS];

typedef struct WrBackground {
    WrBackgroundKind kind;
    double top[3], bottom[3]; /* 0..1e6 */
} WrBackground;

/* The background colour of a row of a picture of `height` rows; row 0 is on top. A gradient has equal
   steps of sRGB codes, so that it looks even, from the first row's middle to the last one's; for
   surroundings `top`. Any finite colours >= 0. */
void wr_background_row(const WrBackground *background, int row, int height, float out[3]);
bool wr_background_equal(const WrBackground *a, const WrBackground *b);
