/* Packing of several maps into one picture, one per channel, as numbers 0..1. */
#include "export/channel_packing.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "export/job.h"
#include "scene/scene.h"
#include "shade/reflection.h"

#include <string.h>

/* Possible content of a channel: a kind that is computed as a whole, from its first code to its last. */
typedef struct Filling {
    const char *word, *kind;
    bool turned; /* inverted: 1 - value */
    WrMaterialRole role;
} Filling;

/* Without a kind: a constant of the material. */
static const Filling fillings[] = {
    { "occlusion", "occlusion", false, WR_ROLE_OCCLUSION },
    { "roughness", "roughness", false, WR_ROLE_ROUGHNESS },
    { "smoothness", "roughness", true, WR_ROLE_ROUGHNESS },
    { "metalness", NULL, false, WR_ROLE_METALNESS },
    { "height", "displacement", false, WR_ROLE_NONE },
    { "cavity", "cavity", false, WR_ROLE_NONE },
    { "curvature", "curvature", false, WR_ROLE_NONE },
    { "mask", "mask", false, WR_ROLE_NONE },
    { "wear", "wear", false, WR_ROLE_NONE },
};
#define FILLINGS ((int)WR_LENGTH(fillings))

/* ---- options ---- */

static const char *filling_word(const void *ctx, int i)
{
    (void)ctx;
    return i < FILLINGS ? fillings[i].word : i == FILLINGS ? "a number 0..1" : NULL;
}

static bool fill_channel(const char *name, int channel, WrExportOptions *options, const char *value,
                         WrError *err)
{
    WrExportPack *pack = &options->pack[channel];
    double number;
    for (int i = 0; i < FILLINGS; i++)
        if (strcmp(fillings[i].word, value) == 0) {
            *pack = (WrExportPack){ .filling = i + 1 };
            return true;
        }
    if (wr_number_parse(value, strlen(value), &number) && number >= 0 && number <= 1) {
        *pack = (WrExportPack){ .filling = WR_PACK_NUMBER, .number = number };
        return true;
    }
    char what[80];
    snprintf(what, sizeof what, "%s '%.40s'", name, value);
    return wr_fail_word(err, what, value, filling_word, NULL);
}

bool wr_export_set_red(WrExportOptions *options, const char *value, WrError *err)
{
    return fill_channel("red", 0, options, value, err);
}

bool wr_export_set_green(WrExportOptions *options, const char *value, WrError *err)
{
    return fill_channel("green", 1, options, value, err);
}

bool wr_export_set_blue(WrExportOptions *options, const char *value, WrError *err)
{
    return fill_channel("blue", 2, options, value, err);
}

bool wr_export_set_alpha(WrExportOptions *options, const char *value, WrError *err)
{
    return fill_channel("alpha", 3, options, value, err);
}

/* ---- the map ---- */

int wr_export_packed_channels(const WrExportJob *job, char (*names)[WR_EXPORT_NAME])
{
    static const char letters[] = "RGBA";
    const int count = job->options.pack[3].filling ? 4 : 3;
    for (int c = 0; c < count; c++) names[c][0] = letters[c], names[c][1] = '\0';
    return count;
}

/* Content of channel c; default: occlusion, roughness, metalness. */
static WrExportPack pack_of(const WrExportOptions *options, int c)
{
    static const int usual[] = { 1, 2, 4, 1 };
    WrExportPack pack = options->pack[c];
    if (!pack.filling) pack.filling = usual[c];
    return pack;
}

static const Filling *filling_of(const WrExportPack *pack)
{
    return pack->filling > 0 ? &fillings[pack->filling - 1] : NULL;
}

WrMaterialRole wr_export_packed_role(const WrExportOptions *options, int c, bool *turned)
{
    const WrExportPack pack = pack_of(options, c);
    const Filling *filling = filling_of(&pack);
    *turned = filling && filling->turned;
    return filling ? filling->role : WR_ROLE_NONE;
}

static void put_constant(WrExportJob *job, int c, float x)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    for (size_t i = 0; i < texels; i++) job->map[i * (size_t)job->channels + (size_t)c] = x;
}

/* Stores a map's codes as 0..1: 0 for its first code, 1 for its last, linear in between. */
static void put_map(WrExportJob *job, int c, const WrExportJob *one, bool turned)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    const WrExportReport *report = &one->report;
    const bool middle = report->zero_code >= 0;
    const double low = middle ? -report->amplitude : report->code_low;
    const double high = middle ? report->amplitude : report->code_high;
    const double scale = high > low ? 1 / (high - low) : 0;
    for (size_t i = 0; i < texels; i++) {
        double x = high > low ? scale * ((double)one->map[i] - low) : 0.5;
        x = x < 0 ? 0 : x < 1 ? x : 1;
        job->map[i * (size_t)job->channels + (size_t)c] = (float)(turned ? 1 - x : x);
    }
}

static bool make_channel(WrExportJob *job, int c, WrError *err)
{
    const WrExportPack pack = pack_of(&job->options, c);
    const Filling *filling = filling_of(&pack);
    if (!filling || !filling->kind) {
        const WrMaterial *material = &job->scene->material;
        const double metal = wr_reflects[material->model].metalness ? material->metalness : 0;
        put_constant(job, c, (float)(filling ? metal : pack.number));
        return true;
    }
    /* The channel's kind runs as a job of its own on the same table; only its map and the range of its codes are used. */
    WrExportJob one = *job;
    one.kind = wr_export_find(filling->kind);
    one.channels = 1;
    one.map = NULL;
    one.attribute_count = 0;
    if (one.options.depth == 32) one.options.depth = 16; /* the range of its codes is needed */
    const bool good = one.kind->make(&one, err);
    if (good) put_map(job, c, &one, filling->turned);
    job->report.replaced = one.report.replaced;
    for (int i = 0; i < one.attribute_count; i++) wr_text_fini(&one.attribute_texts[i]);
    wr_free(one.map);
    return good;
}

bool wr_export_packed_make(WrExportJob *job, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    job->map = wr_try_alloc(texels * (size_t)job->channels, sizeof(float), "map", err);
    bool good = job->map != NULL;
    for (int c = 0; c < job->channels && good; c++) {
        WrProgressPart share;
        const WrProgress *whole =
            wr_progress_enter(&share, (double)c / job->channels, (c + 1.0) / job->channels);
        good = make_channel(job, c, err);
        wr_progress_set(whole);
    }
    if (!good) return false;
    wr_export_report_range(job, "channels");
    wr_export_codes(job, 0, 1);
    return true;
}

void wr_export_packed_describe(WrExportJob *job)
{
    WrText *text = wr_export_attribute(job, "wrinkle:channels");
    for (int c = 0; c < job->channels; c++) {
        const WrExportPack pack = pack_of(&job->options, c);
        const Filling *filling = filling_of(&pack);
        if (c) wr_text_add(text, ",");
        if (filling) wr_text_add(text, filling->word);
        else wr_text_add_number(text, pack.number);
    }
    wr_export_map_describe(job);
}
