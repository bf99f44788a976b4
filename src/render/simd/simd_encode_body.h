/* simd_encode_body.h - SIMD 8-bit encoding of finished colours, with the codes of pixel_encode.h. Part of simd_set_body.h. Fetching from the table costs more than the curve. So the curve is computed to
   CODE_OFF of a code, and the table is used only for vectors in which that does not determine some sample's
   code. */

#define CODE_OFF 2e-4f
#define CODE_TOE 0.0031308f

/* 255 s(x) + 1/2, a code and its fraction, for 0 <= x < 1. */
ALWAYS Wide curve_of(Wide x)
{
    const Wide t = w_mantissa(x) - w_all(1.5f);
    const Wide root =
        w_all(1.18405354f) +
        t * (w_all(0.328906238f) +
             t * (w_all(-0.0639548749f) +
                  t * (w_all(0.0224240758f) +
                       t * (w_all(-0.00964535028f) +
                            t * (w_all(0.0052354401f) + t * w_all(-0.00269152573f))))));
    const Wide y = root * w_curve_scale(x) + w_all(0.5f - 255.0f * 0.055f);
    return w_pick(w_less(x, w_all(CODE_TOE)), w_all(0.5f) + w_all(255.0f * 12.92f) * x, y);
}

/* A channel's codes, and the lanes in which the curve does not determine them. */
typedef struct Coded {
    WideInt code;
    WideMask unsure;
} Coded;

ALWAYS Coded code_by_curve(Wide light)
{
    const Wide x = w_min(w_max(light, w_all(0.0f)), w_all(0x1.fffffep-1f)), y = curve_of(x);
    /* Near a whole number it is uncertain on which side y is. */
    const Wide off = w_abs(w_off_nearest(y));
    return (Coded){ w_whole(y), w_either(w_less(off, w_all(CODE_OFF)), w_odd(light)) };
}

/* A strip's codes of one channel, and for each vector whether some lane is uncertain. */
static void code_channel(const float *light, int count, int32_t *code, unsigned char *unsure)
{
    for (int i = 0; i < count; i += WIDE) {
        const Coded at = code_by_curve(w_load(light + i));
        w_store_int(code + i, at.code);
        unsure[i / WIDE] |= (w_bits(at.unsure) & w_first_bits(count - i)) != 0;
    }
}

/* Codes of up to WIDE samples from i on by the table; grey: red stands for all channels. Returns the number of
   non-finite values. */
static int codes_by_table(const uint32_t *bins, const WrStrip *strip, bool grey, int i, int count,
                          uint32_t *out)
{
    const float *const red = strip->cr + i;
    const float *const from[3] = { red, grey ? red : strip->cg + i, grey ? red : strip->cb + i };
    int odd = 0;
    for (int k = 0; k < count && k < WIDE; k++) {
        uint32_t code[3];
        for (int c = 0; c < 3; c++) {
            const bool good = wr_is_finite_f(from[c][k]);
            code[c] = wr_code_at(bins, wr_srgb_bin_position(good ? from[c][k] : 0.0f));
            odd += !good;
        }
        out[k] = wr_code_pack(code[0], code[1], code[2]);
    }
    return odd;
}

static int grey_codes(const uint32_t *bins, const WrStrip *strip, uint32_t *out)
{
    const int count = strip->count;
    int odd = 0;
    for (int i = 0; i < count; i += WIDE) {
        const unsigned of = w_first_bits(count - i);
        const Coded at = code_by_curve(w_load(strip->cr + i));
        if (w_bits(at.unsure) & of) odd += codes_by_table(bins, strip, true, i, count - i, out + i);
        else w_store_some((int32_t *)out + i, of, w_opaque(at.code, at.code, at.code));
    }
    return odd;
}

/* Short loops: a processor reorders only a limited number of operations. */
static int wide_codes(const uint32_t *bins, const WrStrip *strip, bool grey, uint32_t *out)
{
    const int count = strip->count;
    int32_t r[WR_SPAN], g[WR_SPAN], b[WR_SPAN];
    unsigned char unsure[WR_SPAN / WIDE] = { 0 };
    int odd = 0;
    if (grey) return grey_codes(bins, strip, out);
    code_channel(strip->cr, count, r, unsure);
    code_channel(strip->cg, count, g, unsure);
    code_channel(strip->cb, count, b, unsure);
    for (int i = 0; i < count; i += WIDE) {
        const WideInt all = w_opaque(w_load_int(r + i), w_load_int(g + i), w_load_int(b + i));
        if (unsure[i / WIDE]) odd += codes_by_table(bins, strip, false, i, count - i, out + i);
        else w_store_some((int32_t *)out + i, w_first_bits(count - i), all);
    }
    return odd;
}
