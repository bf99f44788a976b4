/* tone_mapping.h - conversion of light to the 8-bit codes of a picture: exposure, and treatment of
   light above 1.

   Float pictures keep the light unchanged. */
#pragma once
#include "image/display_view.h"

#include <stdbool.h>

typedef enum WrToneKind {
    WR_TONE_CLIP, /* light above 1 is white */
    WR_TONE_SOFT, /* from 1/2 on light x becomes 1 - 1 / 4x: never reaches white; for each channel
                     separately */
    WR_TONE_KINDS
} WrToneKind;
/* As in commands: "clip", "soft". */
extern const char *const wr_tone_names[WR_TONE_KINDS];

typedef struct WrTone {
    WrToneKind kind;
    double exposure;           /* -20..20 stops: light is multiplied by 2^exposure first */
    const WrDisplayView *view; /* in place of kind and of the sRGB curve; NULL: none */
} WrTone;

/* A curve for loops: y = gain x; if y > knee, 1 - (1 - knee)^2 / (y + 1 - 2 knee), which continues with
 * the same slope. */
typedef struct WrToneCurve {
    float gain, knee;
    bool plain;                /* gain 1 and no knee: codes are those of the light itself */
    const WrDisplayView *view; /* ready, applied after gain; NULL: none */
} WrToneCurve;
WrToneCurve wr_tone_curve_params(const WrTone *tone);
/* A colour of light, in place. With a view it becomes the linear light that sRGB shows as the view's codes. */
void wr_tone_colour(const WrTone *tone, float rgb[3]);

bool wr_tone_equal(const WrTone *a, const WrTone *b);
