/* stage_reflection_body.h - microfacet lights: highlights, and early-outs for runs of samples. Part of
   pipeline_body.h. */

/* Kernel parameters of a model other than Blinn-Phong. */
static WR_T(WrKernMatter) matter_of(const WrMatter *m)
{
    WR_T(WrKernMatter) out = { .kd = (REAL)m->kd, .ks = (REAL)m->ks };
    for (int c = 0; c < 3; c++) out.colour[c] = (REAL)m->colour[c];
    out.shininess = (REAL)m->shininess, out.scale = (REAL)m->scale, out.alpha = (REAL)m->alpha;
    out.ior = (REAL)m->ior, out.f0 = (REAL)m->f0, out.metal = (REAL)m->metal;
    out.a = (REAL)m->a, out.b = (REAL)m->b;
    out.mean = (REAL)m->mean, out.again = (REAL)m->again;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) out.albedo[i] = (REAL)m->albedo[i];
    return out;
}

/* The kernel of such a model; NULL: the model is computed in stages. */
static WR_T(WrReflectKernel) reflect_of(const WrTileJob *job)
{
    const WrEnergy energy = job->plan->kept ? WR_ENERGY_KEPT : WR_ENERGY_PUBLISHED;
    return KERNELS_OF(job)->reflect[job->plan->model][energy];
}

/* Brightness below which `dials faint=` omits a highlight, relative to the lamp's light; 0: never. */
static REAL least_of(const WrTileJob *job, const WR_T(WrKernLight) * light)
{
    const double most =
        fmax((double)light->rgb[0], fmax((double)light->rgb[1], (double)light->rgb[2]));
    return most > 0 ? (REAL)(job->plan->faint / most) : (REAL)0;
}

/* True if no highlight in the run is wider than the material's own (E39; after bend_strip). */
static bool is_narrow(const WrTileJob *job, const Strip *strip)
{
    if (!runs(job, WR_EFFECT_SPREAD)) return true;
    return !runs(job, WR_EFFECT_WIDENED) && strip->gathered;
}

static double chord_of(double cosine)
{
    return sqrt(fmax(0, 2 - 2 * cosine)) + 1e-3; /* margin for the rounding of the cosine */
}

/* Upper bound of a highlight over a run (E37). S0 = l0 + v0 is S = l + v of one sample; no other S is farther
   from it than e, so h is within y = asin(e / |S0|) of the axis, and n' no nearer to h than x - y, x its angle
   to the axis:
     D is at most that of this angle,   V (n.l) at most 1 / (2 sqrt(a^2 + (1 - a^2) (n.v)^2)),
     G / (n.v) at most 1 / (n.v),
     F at most f0 + (1 - f0) (1 - v.h)^5 of v.h = (|S0| - e) / 2. */
static double most_of(const WR_T(WrKernMatter) * m, WrReflectHighlight highlight, double length,
                      const REAL found[4])
{
    const double e = chord_of((double)found[2]) + chord_of((double)found[3]);
    const double nv = (double)found[0], a2 = (double)m->alpha * (double)m->alpha;
    if (!(e < 0.5 * length)) return INFINITY;
    const double cx = fmin((double)found[1] + 1e-6, 1), sx = sqrt(1 - cx * cx);
    const double sy = e / length, cy = sqrt(1 - sy * sy); /* sine and cosine of the angle */
    if (!(cx < cy)) return INFINITY;
    const double off = 1 - fmax(0, fmin(0.5 * (length - e), 1)), p = off * off * off * off * off;
    const double c = fmax(0, cx * cy + sx * sy), w = a2 * c * c + 1 - c * c;
    const double f0 = (double)m->f0, metal = (double)m->metal, f = f0 + (1 - f0) * p;
    const double d = (double)m->ks * a2 / (w * w);
    switch (highlight) {
    case WR_HIGHLIGHT_CAVITIES: return d * (double)m->scale / nv;
    case WR_HIGHLIGHT_SMITH:
        return d * 0.5 / sqrt(a2 + (1 - a2) * nv * nv) * (f * (1 - metal) + metal);
    case WR_HIGHLIGHT_NONE:
    case WR_HIGHLIGHT_HALF:
    case WR_HIGHLIGHT_POWER: break;
    }
    return INFINITY;
}

/* True if every highlight is certainly below `least`. *faces: every n' faces the viewer. */
static bool is_faint(const WrTileJob *job, const WR_T(WrKernMatter) * m, const Strip *strip,
                     bool *faces)
{
    const int mid = strip->count / 2;
    const REAL v0[3] = { strip->vx[mid], strip->vy[mid], strip->vz[mid] };
    const REAL l0[3] = { strip->lx[mid], strip->ly[mid], strip->lz[mid] };
    REAL axis[3], found[4], sum = 0;
    for (int k = 0; k < 3; k++) axis[k] = v0[k] + l0[k], sum += axis[k] * axis[k];
    const double length = sqrt((double)sum);
    for (int k = 0; k < 3; k++) axis[k] = length > 0 ? axis[k] / (REAL)length : 0;
    KERNELS_OF(job)->survey(axis, v0, l0, strip, found);
    *faces = (double)found[0] >= WR_FACED_FROM;
    return *faces && most_of(m, wr_reflects[job->plan->model].highlight, length, found) <
                         0.999 * (double)m->least;
}

/* Microfacet form for this run (E37, E39, E40). */
static WrReflectSpread form_of(const WrTileJob *job, const WR_T(WrKernMatter) * matter,
                               const Strip *strip)
{
    bool faces = false;
    if (!is_narrow(job, strip)) return job->plan->lean ? WR_REFLECT_LEAN : WR_REFLECT_ROUND;
    if (runs(job, WR_EFFECT_VARIED) || runs(job, WR_EFFECT_FACED) ||
        !wr_reflects[job->plan->model].facets)
        return WR_REFLECT_AS_IT_IS;
    if (matter->least > 0 && is_faint(job, matter, strip, &faces)) return WR_REFLECT_DULL;
    if (matter->least > 0 ? faces : KERNELS_OF(job)->faces(strip)) return WR_REFLECT_FACING;
    return WR_REFLECT_AS_IT_IS;
}

/* Adds one light by a model other than Blinn-Phong. Returns true if its highlight was skipped. */
static bool reflect_strip(const WrTileJob *job, const WR_T(WrKernLight) * light, Strip *strip,
                          Watch *watch)
{
    WR_T(WrKernMatter) matter = matter_of(&job->matter);
    const bool shines = runs(job, WR_EFFECT_SPECULAR);
    matter.least = least_of(job, light);
    const WrReflectSpread how = form_of(job, &matter, strip);
    if (runs(job, WR_EFFECT_VARIED))
        KERNELS_OF(job)->reflect_vary(light, &matter, VARY_OF(job), job->plan->model,
                                      job->plan->kept, how, strip);
    else reflect_of(job)(light, &matter, how, strip);
    if (runs(job, WR_EFFECT_DIFFUSE)) did(watch, WR_EFFECT_DIFFUSE);
    if (shines) did(watch, WR_EFFECT_SPECULAR);
    if (runs(job, WR_EFFECT_KEPT)) did(watch, WR_EFFECT_KEPT);
    if (runs(job, WR_EFFECT_FACED)) did(watch, WR_EFFECT_FACED);
    if (runs(job, WR_EFFECT_FAINT)) did(watch, WR_EFFECT_FAINT);
    did(watch, WR_EFFECT_MODEL);
    watch_lap(watch, shines ? WR_STAGE_SPECULAR : WR_STAGE_DIFFUSE);
    keep_half3(job, strip->dr, strip->dg, strip->db, strip->count, watch);
    keep_half3(job, strip->sr, strip->sg, strip->sb, strip->count, watch);
    return how == WR_REFLECT_DULL;
}
