#include "render/textures/solid_texture_setup.h"

#include "noise/octaves.h"
#include "scene/scene.h"
#include "shade/solid_texture.h"
#include "surface/surface.h"

#include <math.h>

/* ---- solid texture footprint ---- */

#define LOOKS                                                                                      \
    33 /* sample points along u and along v, with ends: on round surfaces the longest tangents are there */
#define STEEP 3.75 /* largest slope of value noise in -1..1, per cell */
/* Texels per band of the pattern: if two of them lie along a pixel, a band is 1.5 pixels wide. */
#define FINE 3

bool wr_solid_texture_resolution_known(const WrScene *scene)
{
    const WrInversion how = wr_surfaces[scene->shape.kind]->inversion;
    int columns, rows;
    wr_surface_cells(&scene->shape, &columns, &rows);
    return columns * rows == 1 && !scene->displaced && !wr_shape_endless(&scene->shape) &&
           (how == WR_INVERT_PLANE || how == WR_INVERT_SPHERE || how == WR_INVERT_CYLINDER ||
            how == WR_INVERT_CONE);
}

/* Number of bands of the pattern per unit of space.
   Bound of |grad t|: of rings plus amount times the sum of the octaves' slopes. A band is half a period,
   narrower where light and dark have unequal shares. */
static double bands(const WrSolidTexture *grain)
{
    const WrSolidTextureInfo *info = &wr_grains[grain->kind];
    WrOctavesPlan noise;
    double slope = 0, finest = 0;
    wr_solid_texture_noise(grain, &noise);
    for (int i = 0; i < noise.used && info->noisy; i++) {
        slope += STEEP * noise.octave[i].amplitude * noise.octave[i].frequency[0];
        finest = fmax(finest, noise.octave[i].frequency[0]);
    }
    if (!info->noisy) return sqrt(3) * grain->rings; /* along a cube's diagonal */
    if (!info->ringed) return 2 * finest;
    const double moved = grain->rings + fabs(grain->amount) * slope;
    const double narrow = info->shared ? fmin(grain->share, 1 - grain->share) : 0.5;
    return moved / fmax(narrow, 1e-3);
}

/* Texels along u and v as if the pattern were a table: adaptive sampling compares them with a pixel. */
void wr_solid_texture_texels(const WrScene *scene, double texels[2])
{
    double along[2] = { 0, 0 };
    texels[0] = texels[1] = 0;
    if (scene->grain.kind == WR_SOLID_TEXTURE_OFF || !wr_solid_texture_resolution_known(scene))
        return;
    for (int k = 0; k < LOOKS * LOOKS; k++) {
        WrSurfacePoint at;
        wr_surface_at(&scene->shape, 0, (double)(k % LOOKS) / (LOOKS - 1),
                      (double)(k / LOOKS) / (LOOKS - 1), &at);
        along[0] = fmax(along[0], v3_len(at.pu)), along[1] = fmax(along[1], v3_len(at.pv));
    }
    for (int c = 0; c < 2; c++) texels[c] = FINE * along[c] * bands(&scene->grain);
}

/* A kernel unit is 1 / scale object units: lengths are multiplied by scale, frequencies divided. */
void wr_solid_texture_kern_fill(const WrSolidTexture *grain, WrSolidTextureKind kind, bool noisy,
                                bool faded, double scale, WrKernGraind *out)
{
    const WrSolidTextureNoise of = wr_grains[grain->kind].noise;
    WrOctavesPlan noise;
    wr_solid_texture_noise(grain, &noise);
    *out = (WrKernGraind){ .kind = kind,
                           .axis = grain->axis,
                           .noise = of,
                           .faded = faded,
                           .mean = wr_solid_texture_means[of],
                           .variance = wr_solid_texture_variances[of],
                           .fading = wr_solid_texture_fadings[of],
                           .edge = wr_solid_texture_edge(grain),
                           .height = grain->height * scale,
                           .rings = grain->rings / scale,
                           .share = grain->share,
                           .amount = grain->amount,
                           .octaves = noisy ? noise.used : 0 };
    for (int c = 0; c < 3; c++) out->light[c] = grain->light[c], out->dark[c] = grain->dark[c];
    for (int i = 0; i < out->octaves; i++) {
        const WrOctave *octave = &noise.octave[i];
        out->start[i] = wr_lattice_hash_start(octave->noise.lattice.seed);
        out->frequency[i] = octave->frequency[0] / scale;
        out->amplitude[i] = octave->amplitude;
        for (int a = 0; a < 3; a++) out->offset[i][a] = octave->offset[a];
    }
}

void wr_solid_texture_kern_narrow(const WrKernGraind *grain, WrKernGrain *out)
{
    *out = (WrKernGrain){ .kind = grain->kind,
                          .axis = grain->axis,
                          .noise = grain->noise,
                          .faded = grain->faded,
                          .mean = (float)grain->mean,
                          .variance = (float)grain->variance,
                          .fading = (float)grain->fading,
                          .edge = (float)grain->edge,
                          .height = (float)grain->height,
                          .rings = (float)grain->rings,
                          .share = (float)grain->share,
                          .amount = (float)grain->amount,
                          .octaves = grain->octaves };
    for (int c = 0; c < 3; c++)
        out->light[c] = (float)grain->light[c], out->dark[c] = (float)grain->dark[c];
    for (int i = 0; i < grain->octaves; i++) {
        out->start[i] = grain->start[i];
        out->frequency[i] = (float)grain->frequency[i];
        out->amplitude[i] = (float)grain->amplitude[i];
        for (int a = 0; a < 3; a++) out->offset[i][a] = (float)grain->offset[i][a];
    }
}
