/* simd_sphere_rows_body.h - SIMD evaluation of sphere rows (sphere_rows.h). Part of simd_set_body.h. */

/* gx + i is exact for whole numbers up to 2^24; x of neighbouring lanes differ by 1. */
ALWAYS Wide row_places(float gx, int i)
{
    return w_all(gx + (float)i) + w_count();
}

typedef struct WideCurve {
    Wide c0, c1, c2;
} WideCurve;

ALWAYS WideCurve w_curve(const WrForm *form, const WrChord *chord)
{
    float c[3];
    wr_form_along(form, chord, c);
    return (WideCurve){ w_all(c[0]), w_all(c[1]), w_all(c[2]) };
}
/* Horner's scheme: two products per polynomial and pixel. */
ALWAYS Wide w_bent(WideCurve of, Wide x)
{
    return of.c0 + x * (of.c1 + x * of.c2);
}
ALWAYS Wide w_straight(WideCurve of, Wide x)
{
    return of.c0 + x * of.c1;
}

/* n.w along a row. */
typedef struct WideSlant {
    WideCurve along, across;
} WideSlant;

ALWAYS WideSlant w_slant(const WrSlant *of, const WrChord *chord)
{
    return (WideSlant){ w_curve(&of->along, chord), w_curve(&of->across, chord) };
}
/* n.w times d.d. */
ALWAYS Wide w_slanted(const WideSlant *of, Wide x, Wide r)
{
    return w_bent(of->along, x) - r * w_straight(of->across, x);
}

/* n and 1 / |d|; false: positions are not exact. */
static bool chord_points(const WrSphereRows *ball, float gx, float gy, int count, WrStrip *strip)
{
    WrChord chord;
    if (!wr_chord_of(ball, (double)gx, (double)gy, count, &chord)) return false;
    const WideCurve dd = w_curve(&ball->dd, &chord), rr = w_curve(&ball->rr, &chord);
    const WideSlant x_of = w_slant(&ball->n[0], &chord), y_of = w_slant(&ball->n[1], &chord);
    const WideSlant z_of = w_slant(&ball->n[2], &chord);
    const float from = (float)((double)gx - chord.middle);
    const int hits = chord.last - chord.first + 1;
    strip->count = hits > 0 ? hits : 0;
    for (int i = 0; i < hits; i += WIDE) {
        const Wide x = row_places(from, chord.first + i);
        const Wide inv = w_rsqrt(w_bent(dd, x)), r = w_root(w_bent(rr, x));
        const WideVec n = { w_slanted(&x_of, x, r), w_slanted(&y_of, x, r),
                            w_slanted(&z_of, x, r) };
        const WideVec unit = w_scale(n, inv * inv);
        W_STORE3(strip, n, i, unit);
        w_store(strip->s + i, inv);
        w_store_counted(strip->index + i, chord.first + i);
    }
    return true;
}

/* ---- smooth spheres under a distant lamp ---- */

/* The highlight for given n.l, n.v and l.v: n.h = (n.l + n.v) / |l + v|. */
ALWAYS Wide broad_highlight(const Lamp *of, Wide n_dot_l, Wide n_dot_v, Wide l_dot_v)
{
    const Wide half = w_all(0.5f), size = w_max(half + half * l_dot_v, w_all(1e-7f));
    const Wide n_dot_h = (n_dot_l + n_dot_v) * half * w_rsqrt(size);
    WideMask shown = w_less(of->least, n_dot_h);
    if (of->gate) shown = w_both(shown, w_less(w_all(0.0f), n_dot_l));
    return whole_power(w_kept(shown, n_dot_h), of->whole);
}

/* Polynomials along a row from which the light is computed.
   lit = n.l d.d along the row: the light of a smooth sphere needs no n, v or l per pixel. */
typedef struct SmoothRow {
    WideCurve dd, rr;
    WideSlant lit;
    float from; /* x of the row's pixel 0 */
} SmoothRow;

/* Lights the chord. Returns the largest n.l.
   n.v = r / |d|, and l.v = -d.l / |d| from `across`, which is d.l. */
ALWAYS float smooth_chord(const SmoothRow *row, const Scenery *s, const WrWidePaint how, int first,
                          WrStrip *strip)
{
    const int count = strip->count;
    const Wide one = w_all(1.0f);
    Wide largest = w_all(-1.0f);
    for (int i = 0; i < count; i += WIDE) {
        const Wide x = row_places(row->from, first + i);
        const Wide inv = w_rsqrt(w_bent(row->dd, x)), inv2 = inv * inv;
        const Wide r = w_root(w_bent(row->rr, x)), across = w_straight(row->lit.across, x);
        const Wide n_dot_l = (w_bent(row->lit.along, x) - r * across) * inv2;
        const Wide lobe = broad_highlight(&s->lamp, n_dot_l, r * inv, -across * inv);
        const Wide lit = w_max(n_dot_l, w_all(0.0f));
        w_store_counted(strip->index + i, first + i);
        largest = w_max(largest, w_among(w_first_bits(count - i), n_dot_l, largest));
        if (how == WR_WIDE_LATER) {
            w_store(strip->n_dot_l + i, lit), w_store(strip->sr + i, lobe);
            w_store(strip->s + i, r), w_store(strip->n_len + i, inv2);
            continue;
        }
        w_store(strip->cr + i, channel_lit(s->red, one, s->ambient, lit, lobe));
        if (how == WR_WIDE_RED) continue;
        w_store(strip->cg + i, channel_lit(s->green, one, s->ambient, lit, lobe));
        w_store(strip->cb + i, channel_lit(s->blue, one, s->ambient, lit, lobe));
    }
    return w_largest(largest);
}

/* u and v from the values that smooth_chord stored.
   LATER keeps r in strip->s and 1 / d.d in n_len. */
static void chord_parameters(const WrSphereRows *ball, const WrChord *chord, float from,
                             WrStrip *strip)
{
    const int count = strip->count;
    const WideSlant x_of = w_slant(&ball->n[0], chord), y_of = w_slant(&ball->n[1], chord);
    const WideSlant z_of = w_slant(&ball->n[2], chord);
    for (int i = 0; i < count; i += WIDE) {
        const Wide x = row_places(from, chord->first + i);
        const Wide r = w_load(strip->s + i);
        const WideVec n = { w_slanted(&x_of, x, r), w_slanted(&y_of, x, r),
                            w_slanted(&z_of, x, r) };
        put_parameters_of(n, w_load(strip->n_len + i), strip, i);
    }
}

static bool wide_smooth(const WrSphereRows *ball, const WrRays *rays, const WrKernLight *light,
                        const WrKernShine *shine, const WrKernMaterial *material, float gx,
                        float gy, int count, WrWidePaint how, bool *dark, WrStrip *strip)
{
    WrChord chord;
    if (!ball->shown || light->point || whole_exponent(shine) == 0 ||
        !wr_chord_of(ball, (double)gx, (double)gy, count, &chord))
        return false;
    strip->count = chord.last - chord.first + 1;
    *dark = true;
    if (strip->count <= 0) {
        strip->count = 0;
        return true;
    }
    const Scenery s = scenery_of(rays, light, shine, material);
    const SmoothRow row = { w_curve(&ball->dd, &chord), w_curve(&ball->rr, &chord),
                            w_slant(&ball->lit, &chord), (float)((double)gx - chord.middle) };
    float most;
    switch (how) {
    case WR_WIDE_RED: most = smooth_chord(&row, &s, WR_WIDE_RED, chord.first, strip); break;
    case WR_WIDE_ALL: most = smooth_chord(&row, &s, WR_WIDE_ALL, chord.first, strip); break;
    default:
        most = smooth_chord(&row, &s, WR_WIDE_LATER, chord.first, strip);
        chord_parameters(ball, &chord, row.from, strip);
    }
    *dark = !(most > 0.0f);
    return true;
}

/* The picture's colours under that light.
   First the light with LATER, then fetches of colours, then this: the fetch stage reads u and v of the whole
   strip. */
static void wide_paint(const WrRays *rays, const WrKernLight *light, const WrKernShine *shine,
                       const WrKernMaterial *material, WrStrip *strip)
{
    const Scenery s = scenery_of(rays, light, shine, material);
    const int count = strip->count;
    for (int i = 0; i < count; i += WIDE) {
        const Wide lit = w_load(strip->n_dot_l + i), lobe = w_load(strip->sr + i);
        const Wide r = w_load(strip->cr + i), g = w_load(strip->cg + i), b = w_load(strip->cb + i);
        w_store(strip->cr + i, channel_lit(s.red, r, s.ambient, lit, lobe));
        w_store(strip->cg + i, channel_lit(s.green, g, s.ambient, lit, lobe));
        w_store(strip->cb + i, channel_lit(s.blue, b, s.ambient, lit, lobe));
    }
}
