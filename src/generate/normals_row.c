/* The generator row of heights from a normal map. */
#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "generate/normals.h"
#include "generate/picture.h"
#include "image/image.h"

#include <math.h>

#define SURE 0.2 /* correlation of the curl below which a sign is reported as a guess */

#define YS(X) X(Y_AUTO, "auto") X(Y_UP, "up") X(Y_DOWN, "down")
#define EDGES(X) X(EDGES_AUTO, "auto") X(EDGES_PERIODIC, "periodic") X(EDGES_FREE, "free")
#define SLOPES(X) X(SLOPES_AUTO, "auto") X(SLOPES_SMOOTH, "smooth") X(SLOPES_CENTRAL, "central")
enum { YS(WR_WORD_ID) };
enum { EDGES(WR_WORD_ID) };
enum { SLOPES(WR_WORD_ID) };
static const char *const ys[] = { YS(WR_WORD) NULL };
static const char *const edges[] = { EDGES(WR_WORD) NULL };
static const char *const ways[] = { SLOPES(WR_WORD) NULL };
static const char *const codes[] = { WR_NORMAL_CODES(WR_WORD) NULL };

const WrParam wr_params_normals[] = {
    WR_P_FILE("of the normal map"),
    WR_P_CHANNELS("layer", "channel"),
    WR_P_CHOICE("y", "Green", Y_AUTO, ys,
                "where green points: up (+Y), down (-Y), or as the map itself shows"),
    WR_P_CHOICE("edges", "Edges", EDGES_AUTO, edges,
                "whether the map meets itself; auto: as the table does"),
    WR_P_CHOICE("slopes", "Slopes", SLOPES_AUTO, ways,
                "of a smooth surface, or central differences between texels, as many tools write "
                "them; auto: what fits the map better"),
    WR_P_CHOICE(
        "codes", "Codes", WR_NORMALS_AUTO, codes,
        "slopes, bump-slopes: no normals, but these; unsigned, signed: old names of coding="),
    WR_P_CHOICE("coding", "Coding", WR_CODING_AUTO, wr_codings,
                "of floats: unit, 0..1 stands for -1..1; signed, the vectors' own numbers; auto: "
                "what is nearer to vectors of length 1"),
    { .name = "cell",
      .label = "Cell",
      .help = "size of the map in scene units, as in export",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .components = 2,
      .shape = "w,h",
      .fallback = { 1, 1 },
      .low = 0,
      .above = true,
      .high = 1e9,
      .soft_low = 0,
      .soft_high = 4 },
    WR_P_ABOVE("height", "Height", 1, 0, 1e9, 1, "scene units", "of one table unit, as in bump"),
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "of the lowest"),
    WR_P_END
};

/* Determines the sign of green, and reports it with its certainty. */
static void settle_green(const WrParams *p, WrNormals *normals, const WrGenerateJob *job)
{
    int y = wr_param_whole(p, "y");
    double r = wr_normals_upward(normals);
    bool down = y == Y_DOWN || (y == Y_AUTO && r <= -SURE);
    const char *name = down ? "down (-Y)" : "up (+Y)";
    if (down) wr_normals_flip(normals);
    if (y == Y_AUTO && fabs(r) >= SURE)
        wr_generate_note(job, "green points %s: so its curl agrees to %.0f%%", name,
                         100.0 * fabs(r));
    else if (y == Y_AUTO)
        wr_generate_note(job,
                         "the map does not tell whether green points up or down (its curl agrees "
                         "to %.0f%% either way): taken as up; y=down if bumps come out wrong",
                         100.0 * fabs(r));
    else if (down ? r > SURE : r < -SURE)
        wr_generate_note(job, "green is taken as %s as told, but its curl says the opposite", name);
}

static void say(const WrNormals *n, const WrIntegral *how, const WrGenerateJob *job)
{
    long long count = (long long)n->width * n->height;
    if (n->unknown > 0)
        wr_generate_note(job, "%lld normals of %lld do not face up: taken as flat",
                         (long long)n->unknown, count);
    if (n->steep > 0)
        wr_generate_note(job, "%lld slopes of %lld were brought down to 100", (long long)n->steep,
                         count);
    if (fabs(how->tilt_deg[0]) > 0.05 || fabs(how->tilt_deg[1]) > 0.05)
        wr_generate_note(job,
                         "the map leans by %.2f degrees to the right and %.2f down, which nothing "
                         "that meets itself can: left out",
                         how->tilt_deg[0], how->tilt_deg[1]);
    wr_generate_note(job, "its normals differ from the heights' own by %.2f degrees (rms)",
                     how->residual_deg);
}

/* ratio to the smooth surface's angle below which the map is assumed to come from central
 * differences */
#define BETTER 0.7

/* Integrates with the requested slope definition, or the one with the smaller residual. */
static bool integrate(int slopes, const WrNormals *n, WrIntegral *how, const WrGenerateJob *job,
                      WrSheet *sheet, WrError *err)
{
    how->central = slopes == SLOPES_CENTRAL;
    if (!wr_normals_integrate(n, how, job, sheet, err)) return false;
    bool ring = how->ends[0] == WR_ENDS_RING || how->ends[1] == WR_ENDS_RING;
    if (slopes != SLOPES_AUTO || !ring || how->residual_deg < 1e-3) return true;
    WrIntegral other = *how;
    WrSheet by_differences = { .z = NULL };
    other.central = true;
    if (!wr_normals_integrate(n, &other, job, &by_differences, err)) {
        wr_sheet_fini(sheet);
        return false;
    }
    bool better = other.residual_deg < BETTER * how->residual_deg;
    wr_sheet_fini(better ? sheet : &by_differences);
    if (better) {
        *sheet = by_differences;
        *how = other;
        wr_generate_note(job, "its slopes are central differences");
    }
    return true;
}

static WrEnds ends_of(const WrParams *p, WrWrap wrap)
{
    int choice = wr_param_whole(p, "edges");
    if (choice == EDGES_AUTO) return wrap == WR_WRAP_PERIODIC ? WR_ENDS_RING : WR_ENDS_FREE;
    return choice == EDGES_FREE ? WR_ENDS_FREE : WR_ENDS_RING;
}

static bool make(const WrParams *p, WrNormals *normals, const WrGenerateJob *job, WrRelief *out,
                 WrError *err)
{
    const WrParamValue *cell = wr_param_value(p, "cell");
    double height = wr_param_number(p, "height"), low, high;
    WrSheet sheet = { .z = NULL };
    WrIntegral how = { .ends = { ends_of(p, wr_field_wrap_u(job->like)),
                                 ends_of(p, wr_field_wrap_v(job->like)) },
                       .unit = { cell->number[0] / (height * normals->width),
                                 cell->number[1] / (height * normals->height) } };
    settle_green(p, normals, job);
    if (!integrate(wr_param_whole(p, "slopes"), normals, &how, job, &sheet, err)) return false;
    say(normals, &how, job);
    wr_sheet_range(&sheet, &low, &high);
    double level = wr_param_number(p, "level");
    size_t count = (size_t)sheet.width * (size_t)sheet.height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) sheet.z[k] += level - low;
    bool good =
        wr_sheet_resize(&sheet, wr_field_width(job->like), wr_field_height(job->like), job, err) &&
        wr_sheet_relief(&sheet, job, out, err);
    wr_sheet_fini(&sheet);
    return good;
}

/* The file's label applies if the command does not specify it. */
static WrNormalCodes codes_of(const WrParams *p, const WrImage *image)
{
    const int code = wr_param_whole(p, "codes");
    if (code != WR_NORMALS_AUTO) return (WrNormalCodes)code;
    return image->label.kind == WR_LABEL_SLOPES        ? WR_NORMALS_SLOPES
           : image->label.kind == WR_LABEL_BUMP_SLOPES ? WR_NORMALS_BUMP_SLOPES
                                                       : WR_NORMALS_AUTO;
}

/* Per texel and downwards, or relative to the cell and divided by a number from the file. */
static bool decode_bump_slopes(const WrParams *p, const WrImage *first, WrNormals *out,
                               WrError *err)
{
    const WrImageRequest wish = { .channel = "b1_dhds,b2_dhdt",
                                  .part = wr_param_value(p, "part")->text };
    const WrParamValue *cell = wr_param_value(p, "cell");
    const WrImageLabel *label = &first->label;
    const double k = label->uvslopes, height = wr_param_number(p, "height"),
                 sign = label->turned ? -1 : 1;
    WrImage *image = wr_image_read_wish(wr_param_value(p, "file")->text, &wish, err);
    const bool good =
        image && wr_normals_from_slopes(
                     image, sign * height / cell->number[0] * (k > 0 ? k : image->width),
                     sign * height / cell->number[1] * (k > 0 ? k : image->height), out, err);
    if (image) wr_image_free(image);
    return good;
}

static bool decode(const WrParams *p, const WrImage *image, const WrGenerateJob *job,
                   WrNormals *out, WrError *err)
{
    const WrNormalCodes code = codes_of(p, image);
    if (code == WR_NORMALS_BUMP_SLOPES) return decode_bump_slopes(p, image, out, err);
    const WrCoding coding = code == WR_NORMALS_UNSIGNED ? WR_CODING_UNIT
                            : code == WR_NORMALS_SIGNED ? WR_CODING_SIGNED
                                                        : (WrCoding)wr_param_whole(p, "coding");
    const bool slopes = code == WR_NORMALS_SLOPES;
    const bool good = slopes ? wr_normals_from_slopes(image, 1, -1, out, err)
                             : wr_normals_decode(image, coding, out, err);
    if (good && !slopes && image->type == WR_PIXEL_F32)
        wr_generate_note(job, "floats taken as %s",
                         out->coding == WR_CODING_UNIT
                             ? "coded, 0..1 for -1..1; coding=signed takes them as they are"
                             : "the vectors' own numbers; coding=unit takes 0..1 for -1..1");
    if (!good) wr_error_prefix(err, "%s: ", wr_param_value(p, "file")->text);
    return good;
}

bool wr_picture_normals(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_normals, values };
    WrNormals normals = { .p = NULL };
    WrImage *image = wr_picture_read(&p, "layer", (WrImageRequest){ 0 }, job, err);
    const bool good =
        image && decode(&p, image, job, &normals, err) && make(&p, &normals, job, out, err);
    wr_image_free(image);
    wr_normals_fini(&normals);
    return good;
}
