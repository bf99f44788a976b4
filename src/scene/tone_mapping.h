/* tone_mapping.h - how light becomes the 8-bit codes of a picture: exposure, and what is done with light that no code can show.
   Float pictures keep the light as it is. */
#pragma once
#include <stdbool.h>

typedef enum WrToneKind {
    WR_TONE_CLIP, /* beyond 1 all is white */
    WR_TONE_SOFT, /* from 1/2 on light x is shown as 1 - 1 / 4x: nothing reaches white; each channel by itself */
    WR_TONE_KINDS
} WrToneKind;
/* As in commands: "clip", "soft". */
extern const char *const wr_tone_names[WR_TONE_KINDS];

typedef struct WrTone {
    WrToneKind kind;
    double exposure; /* -20..20 stops: light is multiplied by 2^exposure first */
} WrTone;

/* A curve for loops: y = gain x; where y > knee, 1 - (1 - knee)^2 / (y + 1 - 2 knee), which goes on with the same slope. */
typedef struct WrToneCurve {
    float gain, knee;
    bool plain; /* gain 1 and no knee: codes are those of the light itself */
} WrToneCurve;
WrToneCurve wr_tone_curve(const WrTone *tone);
/* One number of light. */
float wr_tone_at(const WrTone *tone, float light);

bool wr_tone_equal(const WrTone *a, const WrTone *b);
