#include "render/textures/solid_texture_setup.h"

#include "noise/octaves.h"

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
