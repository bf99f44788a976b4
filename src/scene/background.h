/* background.h - what stands behind the objects in 8-bit pictures and in the window: a colour, two that go over into
   each other from top to bottom, the surroundings, or nothing. Float pictures have their coverage instead.
   Colours are linear RGB. */
#pragma once
#include <stdbool.h>

typedef enum WrBackgroundKind {
    WR_BACKGROUND_PLAIN,    /* `top` everywhere */
    WR_BACKGROUND_GRADIENT, /* from `top` to `bottom` */
    WR_BACKGROUND_NONE,     /* pictures that hold alpha have it; others: `top` everywhere */
    WR_BACKGROUND_SURROUNDINGS, /* the scene's surroundings, as the camera sees them; without any: `top` everywhere */
    WR_BACKGROUND_KINDS
} WrBackgroundKind;
/* As in commands: "plain", "gradient", "none", "surroundings". */
extern const char *const wr_background_names[WR_BACKGROUND_KINDS];

typedef struct WrBackground {
    WrBackgroundKind kind;
    double top[3], bottom[3]; /* 0..1e6 */
} WrBackground;

/* The colour behind a row of a picture that is `height` rows high; row 0 is on top. A gradient goes by equal steps of
   sRGB codes, so that it looks even: from the first row's middle to the last one's; of surroundings `top`. Any finite colours >= 0. */
void wr_background_row(const WrBackground *background, int row, int height, float out[3]);
bool wr_background_equal(const WrBackground *a, const WrBackground *b);
