#include "scene/tone_mapping.h"

#include "base/enum_rows.h"

#include <math.h>

WR_ROWS(wr_tone_names);
const char *const wr_tone_names[WR_TONE_KINDS] = {
    [WR_ROW(WR_TONE_CLIP)] = "clip",
    [WR_ROW(WR_TONE_SOFT)] = "soft",
};
WR_ROWS_END(wr_tone_names, WR_TONE_KINDS);

#define NO_KNEE 3.0e38f /* never reached by light */

WrToneCurve wr_tone_curve(const WrTone *tone)
{
    return (WrToneCurve){ .gain = (float)exp2(tone->exposure),
                          .knee = tone->kind == WR_TONE_SOFT ? 0.5f : NO_KNEE,
                          .plain = tone->kind == WR_TONE_CLIP && tone->exposure == 0 };
}

float wr_tone_at(const WrTone *tone, float light)
{
    const WrToneCurve curve = wr_tone_curve(tone);
    const float y = curve.gain * light, left = 1.0f - curve.knee;
    return y > curve.knee ? 1.0f - left * left / (y + 1.0f - 2.0f * curve.knee) : y;
}

bool wr_tone_equal(const WrTone *a, const WrTone *b)
{
    return a->kind == b->kind && a->exposure == b->exposure;
}
