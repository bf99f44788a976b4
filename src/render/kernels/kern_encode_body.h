/* kern_encode_body.h - 8-bit encoding of finished colours. Part of kern_body.h. */

/* Positions in the bins for up to WR_SPAN colours. */
typedef struct Places {
    float r[WR_SPAN], g[WR_SPAN], b[WR_SPAN];
} Places;

/* Writes the bin positions of a colour; non-finite numbers count as 0. Returns 1 if there are any. */
ALWAYS int note_places(Places *to, int i, float r, float g, float b)
{
    const float kr = r - r == 0.0f ? r : 0.0f, kg = g - g == 0.0f ? g : 0.0f;
    const float kb = b - b == 0.0f ? b : 0.0f;
    to->r[i] = wr_srgb_bin_position(kr);
    to->g[i] = wr_srgb_bin_position(kg);
    to->b[i] = wr_srgb_bin_position(kb);
    return (kr == r ? 0 : 1) + (kg == g ? 0 : 1) + (kb == b ? 0 : 1);
}

ALWAYS void codes_of_places(const uint32_t *restrict bins, const Places *from, int count,
                            uint32_t *restrict out)
{
    SIMD for (int i = 0; i < count; i++)
    {
        out[i] = wr_code_pack(wr_code_at(bins, from->r[i]), wr_code_at(bins, from->g[i]),
                              wr_code_at(bins, from->b[i]));
    }
}

/* Encodes the opaque colours of the strip; returns the number of non-finite values. */
FLAT static int kern_codes(const uint32_t *bins, const STRIP *strip, uint32_t *out)
{
    const int count = strip->count;
    Places places;
    int not_finite = 0;
    SIMD_SUM(not_finite) for (int i = 0; i < count; i++)
    {
        not_finite +=
            note_places(&places, i, (float)strip->cr[i], (float)strip->cg[i], (float)strip->cb[i]);
    }
    codes_of_places(bins, &places, count, out);
    return not_finite;
}

/* Tone-mapped light (scene/tone_mapping.h). */
ALWAYS float toned(float x, float gain, float knee)
{
    const float most = 3.0e38f, product = gain * x, left = 1.0f - knee;
    const float y = product < most ? product : most;
    const float bent = y > knee ? 1.0f - left * left / (y + 1.0f - 2.0f * knee) : y;
    return x - x == 0.0f ? bent : x;
}

/* Encodes premultiplied colours [count][4] over a background, which is one colour or [count][4] as well. */
ALWAYS int codes_over(const uint32_t *restrict bins, const WrToneCurve *tone, const bool plain,
                      const float *restrict behind, const int across, int count,
                      const float *restrict rgba, uint32_t *restrict out)
{
    const float gain = plain ? 1.0f : tone->gain, knee = plain ? 1.0f : tone->knee;
    const float r0 = behind[0], g0 = behind[1], b0 = behind[2];
    Places places;
    int not_finite = 0;
    SIMD_SUM(not_finite) for (int i = 0; i < count; i++)
    {
        const float left = 1.0f - rgba[4 * i + 3];
        const float r = rgba[4 * i] + left * (across ? behind[4 * i] : r0);
        const float g = rgba[4 * i + 1] + left * (across ? behind[4 * i + 1] : g0);
        const float b = rgba[4 * i + 2] + left * (across ? behind[4 * i + 2] : b0);
        not_finite +=
            note_places(&places, i, plain ? r : toned(r, gain, knee),
                        plain ? g : toned(g, gain, knee), plain ? b : toned(b, gain, knee));
    }
    codes_of_places(bins, &places, count, out);
    return not_finite;
}

FLAT static int kern_codes_over(const uint32_t *bins, const float behind[3], int count,
                                const float *rgba, uint32_t *out)
{
    return codes_over(bins, NULL, true, behind, 0, count, rgba, out);
}

FLAT static int kern_codes_behind(const uint32_t *bins, const WrToneCurve *tone,
                                  const float *behind, int count, const float *rgba, uint32_t *out)
{
    return codes_over(bins, tone, false, behind, 1, count, rgba, out);
}
