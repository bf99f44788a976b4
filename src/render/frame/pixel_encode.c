#include "render/frame/pixel_encode.h"

#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"
#include "scene/scene.h"

#include <string.h>

/* ---- sRGB ---- */

/* Built in: a comparison with these, instead of a power in float, gives the same code on every processor. */
const float wr_srgb_borders[256] = {
    0.0f,           0.000151763496f, 0.000455290487f, 0.000758817478f, 0.00106234441f,
    0.0013658714f,  0.00166939839f,  0.00197292538f,  0.00227645249f,  0.00257997937f,
    0.00288350624f, 0.00318830088f,  0.00350925932f,  0.00384831498f,  0.00420574797f,
    0.00458183279f, 0.00497683743f,  0.00539102405f,  0.00582465064f,  0.00627796957f,
    0.00675122766f, 0.00724466844f,  0.00775853032f,  0.00829304848f,  0.00884845294f,
    0.00942497049f, 0.0100228256f,   0.010642237f,    0.011283421f,    0.0119465925f,
    0.0126319602f,  0.0133397318f,   0.0140701123f,   0.0148233026f,   0.0155995032f,
    0.0163989104f,  0.0172217153f,   0.0180681143f,   0.0189382937f,   0.0198324434f,
    0.0207507443f,  0.0216933824f,   0.0226605386f,   0.0236523896f,   0.0246691145f,
    0.0257108882f,  0.0267778821f,   0.0278702695f,   0.0289882198f,   0.0301319025f,
    0.0313014798f,  0.0324971229f,   0.0337189883f,   0.0349672437f,   0.0362420455f,
    0.0375435539f,  0.0388719253f,   0.04022732f,     0.041609887f,    0.0430197865f,
    0.0444571637f,  0.0459221713f,   0.0474149622f,   0.0489356853f,   0.0504844859f,
    0.0520615056f,  0.0536668971f,   0.055300802f,    0.0569633618f,   0.0586547181f,
    0.0603750125f,  0.0621243827f,   0.0639029741f,   0.0657109171f,   0.0675483495f,
    0.0694154128f,  0.0713122338f,   0.0732389539f,   0.0751957074f,   0.0771826133f,
    0.0791998208f,  0.0812474415f,   0.0833256245f,   0.085434489f,    0.0875741541f,
    0.089744769f,   0.091946438f,    0.0941793025f,   0.0964434743f,   0.098739095f,
    0.101066269f,   0.10342513f,     0.105815805f,    0.108238399f,    0.110693045f,
    0.113179862f,   0.115698971f,    0.118250482f,    0.120834522f,    0.123451203f,
    0.126100644f,   0.128782958f,    0.131498262f,    0.134246677f,    0.137028307f,
    0.13984327f,    0.142691687f,    0.145573661f,    0.148489311f,    0.151438728f,
    0.15442206f,    0.157439381f,    0.160490826f,    0.163576499f,    0.166696489f,
    0.169850931f,   0.173039913f,    0.176263571f,    0.179521978f,    0.182815254f,
    0.186143503f,   0.189506829f,    0.192905352f,    0.196339145f,    0.199808344f,
    0.203313038f,   0.206853345f,    0.210429341f,    0.214041144f,    0.217688844f,
    0.22137256f,    0.225092396f,    0.228848428f,    0.232640758f,    0.236469507f,
    0.240334779f,   0.244236633f,    0.248175204f,    0.252150565f,    0.256162852f,
    0.260212123f,   0.264298469f,    0.268422037f,    0.272582889f,    0.276781112f,
    0.281016797f,   0.285290092f,    0.289601028f,    0.293949723f,    0.298336297f,
    0.30276081f,    0.30722335f,     0.311724037f,    0.31626296f,     0.32084018f,
    0.325455844f,   0.330109984f,    0.334802747f,    0.339534163f,    0.344304383f,
    0.349113464f,   0.353961498f,    0.358848572f,    0.363774776f,    0.368740231f,
    0.373744965f,   0.378789127f,    0.383872777f,    0.388996005f,    0.3941589f,
    0.399361521f,   0.404604018f,    0.40988642f,     0.415208817f,    0.420571357f,
    0.425974041f,   0.431417018f,    0.436900347f,    0.442424119f,    0.447988421f,
    0.453593314f,   0.459238917f,    0.464925289f,    0.470652521f,    0.476420701f,
    0.482229918f,   0.488080233f,    0.493971765f,    0.499904543f,    0.505878687f,
    0.511894286f,   0.517951429f,    0.524050117f,    0.530190527f,    0.536372721f,
    0.542596757f,   0.548862696f,    0.555170655f,    0.561520696f,    0.567912877f,
    0.574347317f,   0.580824137f,    0.587343335f,    0.593904972f,    0.600509226f,
    0.607156098f,   0.613845706f,    0.62057811f,     0.62735337f,     0.634171605f,
    0.641032875f,   0.647937238f,    0.654884815f,    0.661875665f,    0.668909788f,
    0.675987363f,   0.683108449f,    0.690273106f,    0.697481334f,    0.704733372f,
    0.712029159f,   0.719368815f,    0.72675246f,     0.734180033f,    0.741651773f,
    0.749167681f,   0.756727815f,    0.764332294f,    0.77198112f,     0.779674411f,
    0.787412286f,   0.795194745f,    0.803021908f,    0.810893834f,    0.818810523f,
    0.826772213f,   0.834778786f,    0.842830479f,    0.850927293f,    0.859069228f,
    0.867256522f,   0.875489056f,    0.883767068f,    0.892090559f,    0.900459588f,
    0.908874214f,   0.917334557f,    0.925840616f,    0.934392571f,    0.942990363f,
    0.951634169f,   0.960324049f,    0.969060004f,    0.977842152f,    0.986670554f,
    0.995545268f,
};

/* ---- pixels ---- */

/* The code nearest to a number of a display, 0..1; NaN: 0. */
static uint32_t display_code(float x)
{
    x = x > 0.0f ? x : 0.0f;
    return (uint32_t)(255.0f * (x < 1.0f ? x : 1.0f) + 0.5f);
}

/* Codes of a view. Light is limited, so that a transform with exponents or logarithms stays finite. */
static int64_t view_span(const WrToneCurve *tone, const WrBehind *behind, int across, int count,
                         const float *rgba, uint32_t *out)
{
    const float most = 1e9f;
    int64_t not_finite = 0;
    float rgb[WR_SPAN][3];
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++) {
            const float light =
                rgba[4 * i + c] + (1.0f - rgba[4 * i + 3]) * behind[i * across].colour[c];
            const bool finite = light - light == 0.0f;
            const float product = finite ? tone->gain * light : 0.0f;
            rgb[i][c] = product < most ? product : most;
            not_finite += !finite;
        }
    wr_display_view_apply(tone->view, rgb[0], count);
    for (int i = 0; i < count; i++)
        out[i] =
            wr_code_pack(display_code(rgb[i][0]), display_code(rgb[i][1]), display_code(rgb[i][2]));
    return not_finite;
}

/* A plain tone curve over one colour takes the short loop; else the background's colours are copied out of the
   cells, because they alternate with codes in memory. */
int64_t wr_code_row(const WrPixelEncoder *coder, const WrBehind *behind, int across, int count,
                    const float *rgba, uint32_t *out)
{
    const WrKernels *k = coder->kernels;
    if (coder->tone.plain && !across)
        return k->codes_over(coder->bins, behind->colour, count, rgba, out);
    _Static_assert(sizeof *behind == sizeof(float[4]), "a colour and its code are four floats");
    int64_t not_finite = 0;
    for (int x = 0; x < count; x += WR_SPAN) {
        const int some = count - x < WR_SPAN ? count - x : WR_SPAN;
        if (coder->tone.view) {
            not_finite += view_span(&coder->tone, behind + x * across, across, some,
                                    rgba + 4 * (size_t)x, out + x);
            continue;
        }
        float own[WR_SPAN][4];
        for (int i = 0; i < some; i++)
            memcpy(own[i], behind[(x + i) * across].colour, sizeof behind->colour);
        not_finite +=
            k->codes_behind(coder->bins, &coder->tone, own[0], some, rgba + 4 * (size_t)x, out + x);
    }
    return not_finite;
}

static void give(double to[3], const double axes[9], WrVec3 d)
{
    for (int k = 0; k < 3; k++)
        to[k] = axes[3 * k] * d.x + axes[3 * k + 1] * d.y + axes[3 * k + 2] * d.z;
}

/* Camera rays into the environment; false: the scene shows no environment.
   first + x right + y down is the direction through pixel (x, y), unnormalised: the map needs none of unit
   length. Orthographic: all rays are parallel, the whole background is one direction. */
static bool look_out(const WrScene *scene, double radius, int width, int height, WrOutlook *out)
{
    const WrEnvironment *own = scene ? &scene->environment : NULL;
    const double aspect = (double)width / height;
    WrPlacement place;
    double axes[9];
    if (!own || !own->light) return false;
    if (!(radius > 0 ? wr_scene_place_with_radius(scene, radius, 0, aspect, &place, NULL)
                     : wr_scene_place(scene, 0, aspect, &place, NULL)))
        return false;
    const double high = place.orthographic ? 0 : place.half_height, wide = high * aspect;
    const WrVec3 right = v3_scale(place.right, 2 * wide / width),
                 down = v3_scale(place.up, -2 * high / height);
    WrVec3 first = v3_mad(v3_mad(place.forward, place.right, -wide), place.up, high);
    first = v3_mad(v3_mad(first, right, 0.5), down, 0.5);
    memset(out, 0, sizeof *out); /* compared as bytes */
    wr_environment_map_turn(own->turn_deg, axes);
    out->light = own->light;
    out->strength = own->strength;
    give(out->first, axes, first);
    give(out->right, axes, right);
    give(out->down, axes, down);
    return true;
}

typedef struct Fill {
    WrBackdrop *backdrop;
    const WrPixelEncoder *coder;
} Fill;

/* The direction is linear in the pixel position, from the first pixel's centre.
   Rows are counted in the whole picture (b->first), so a band of a larger picture has the same background. */
static void fill_row(int row, int worker, void *ctx)
{
    (void)worker;
    const Fill *fill = ctx;
    WrBackdrop *b = fill->backdrop;
    const WrOutlook *o = &b->outlook;
    WrBehind *cells = b->cells + (size_t)row * (size_t)b->step;
    const double y = b->first + row;
    for (int x = 0; x < b->width; x++) {
        const float nothing[4] = { 0 };
        double rgb[3];
        const WrVec3 d = { o->first[0] + x * o->right[0] + y * o->down[0],
                           o->first[1] + x * o->right[1] + y * o->down[1],
                           o->first[2] + x * o->right[2] + y * o->down[2] };
        wr_environment_map_at(o->light, d, rgb);
        for (int c = 0; c < 3; c++) cells[x].colour[c] = (float)(o->strength * rgb[c]);
        wr_code_row(fill->coder, &cells[x], 0, 1, nothing, &cells[x].code);
    }
}

static void make_room(WrBackdrop *backdrop, size_t count)
{
    if (backdrop->room >= count) return;
    wr_free(backdrop->cells);
    backdrop->cells = wr_alloc(count, sizeof *backdrop->cells);
    backdrop->room = count;
}

/* b->held is a reference to the map: without it a new map at the same address would pass for the old one. */
static bool stands(const WrBackdrop *b, const WrOutlook *outlook, const WrTone *tone, int width,
                   int height, int first, int rows)
{
    return b->held && memcmp(&b->outlook, outlook, sizeof *outlook) == 0 &&
           wr_tone_equal(&b->tone, tone) && b->width == width && b->height == height &&
           b->first == first && b->rows == rows;
}

static void drop(WrBackdrop *backdrop)
{
    wr_environment_map_free(backdrop->held);
    backdrop->held = NULL;
}

/* Fills one colour, or one for each row.
   cells [rows][step]: step is 0 for one colour, 1 for one a row, `width` for one a pixel; across is the step
   from pixel to pixel. */
static void fill_rows(WrBackdrop *b, const WrBackground *ground, int height, int first, int rows,
                      const WrPixelEncoder *coder)
{
    const float nothing[4] = { 0 };
    drop(b);
    b->step = ground->kind == WR_BACKGROUND_GRADIENT;
    b->across = 0;
    make_room(b, b->step ? (size_t)rows : 1);
    for (int i = 0; i < (b->step ? rows : 1); i++) {
        wr_background_row(ground, first + i, height, b->cells[i].colour);
        wr_code_row(coder, &b->cells[i], 0, 1, nothing, &b->cells[i].code);
    }
}

void wr_backdrop_update(WrBackdrop *backdrop, const WrFrameCodes *of, double radius, int width,
                        int height, int first, int rows, const WrPixelEncoder *coder, WrPool *pool)
{
    WrOutlook outlook;
    if (of->background.kind != WR_BACKGROUND_SURROUNDINGS ||
        !look_out(of->scene, radius, width, height, &outlook)) {
        fill_rows(backdrop, &of->background, height, first, rows, coder);
        return;
    }
    if (stands(backdrop, &outlook, &of->tone, width, height, first, rows)) return;
    drop(backdrop);
    make_room(backdrop, (size_t)width * (size_t)rows);
    backdrop->held = wr_environment_map_share(outlook.light);
    backdrop->outlook = outlook;
    backdrop->tone = of->tone;
    backdrop->width = backdrop->step = width;
    backdrop->height = height;
    backdrop->first = first, backdrop->rows = rows;
    backdrop->across = 1;
    Fill fill = { backdrop, coder };
    wr_pool_run(pool, rows, fill_row, &fill);
}

void wr_backdrop_fini(WrBackdrop *backdrop)
{
    drop(backdrop);
    wr_free(backdrop->cells);
    *backdrop = (WrBackdrop){ 0 };
}
