/* kern_store_body.h - finished colours as 8-bit codes. A part of kern_body.h. */

/* Places in the bins of up to WR_SPAN colours. */
typedef struct Places {
    float r[WR_SPAN], g[WR_SPAN], b[WR_SPAN];
} Places;

/* Of a colour with something that is not finite that counts as 0; 1 for each. */
ALWAYS int note_places(Places *to, int i, float r, float g, float b)
{
    const float kr = r - r == 0.0f ? r : 0.0f, kg = g - g == 0.0f ? g : 0.0f;
    const float kb = b - b == 0.0f ? b : 0.0f;
    to->r[i] = wr_code_place(kr);
    to->g[i] = wr_code_place(kg);
    to->b[i] = wr_code_place(kb);
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

/* Opaque colours of the strip; how many of their numbers were not finite. */
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

/* The same of premultiplied colours [count][4] over a background. */
FLAT static int kern_codes_over(const uint32_t *bins, const float background[3], int count,
                                const float *rgba, uint32_t *out)
{
    const float r0 = background[0], g0 = background[1], b0 = background[2];
    Places places;
    int not_finite = 0;
    SIMD_SUM(not_finite) for (int i = 0; i < count; i++)
    {
        const float left = 1.0f - rgba[4 * i + 3];
        not_finite += note_places(&places, i, rgba[4 * i] + left * r0, rgba[4 * i + 1] + left * g0,
                                  rgba[4 * i + 2] + left * b0);
    }
    codes_of_places(bins, &places, count, out);
    return not_finite;
}
