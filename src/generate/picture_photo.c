/* Heights from the brightness of a picture, in linear light, because the codes of pictures are not
   proportional to it. */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/field.h"
#include "field/ops.h"
#include "generate/picture.h"
#include "image/image.h"

#include <math.h>

#define CHANNELS(X)                                                                                \
    X(LUMINANCE, "luminance")                                                                      \
    X(RED, "red")                                                                                  \
    X(GREEN, "green")                                                                              \
    X(BLUE, "blue")                                                                                \
    X(ALPHA, "alpha")                                                                              \
    X(LARGEST, "max")
enum { CHANNELS(WR_WORD_ID) };
static const char *const channels[] = { CHANNELS(WR_WORD) NULL };
#define LIGHTS(X) X(LINEAR, "linear") X(CODE, "code")
enum { LIGHTS(WR_WORD_ID) };
static const char *const lights[] = { LIGHTS(WR_WORD) NULL };

const WrParam wr_params_photo[] = {
    WR_P_FILE("of the picture"),
    WR_P_CHANNELS("layer", NULL),
    WR_P_CHOICE("channel", "Channel", LUMINANCE, channels, "what counts as height"),
    WR_P_CHOICE("light", "Light", LINEAR, lights,
                "linear: codes of 8 and 16 bits are sRGB; code: they are numbers"),
    WR_P_SEAMLESS(WR_SEAMLESS_BLEND),
    WR_P_NUMBER("highpass", "High pass", 0, 0, 1000, 200, "texels",
                "take away what is wider: shadows, uneven light; 0: nothing"),
    WR_P_SWITCH("stretch", "Stretch", 0, "bring the darkest to 0 and the lightest to 1 first"),
    WR_P_NUMBER("low", "Low", 0, -1e6, 1e6, 1, "", "what is as dark is lowest"),
    WR_P_NUMBER("high", "High", 1, -1e6, 1e6, 1, "", "what is as light is highest"),
    WR_P_NUMBER("gamma", "Gamma", 1, 0.01, 100, 5, "",
                "what is between, to the power 1/gamma: above 1 lifts it"),
    WR_P_SWITCH("invert", "Invert", 0, "dark is high"),
    WR_P_LABELS,
    WR_P_HEIGHT,
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "of the lowest"),
    WR_P_END
};

const char *const wr_picture_labels[] = { WR_PICTURE_LABELS(WR_WORD) NULL };

#define FLAT (1.0 / 255) /* of the heights: less than a step of 8 bits */

double wr_picture_light(double code)
{
    return code <= 0.04045 ? code / 12.92 : wr_pow((code + 0.055) / 1.055, 2.4);
}

WrImage *wr_picture_read(const WrParams *params, const char *channels_, WrImageRequest wish,
                         const WrGenerateJob *job, WrError *err)
{
    const char *path = wr_param_value(params, "file")->text;
    wish.channel = wr_param_value(params, channels_)->text;
    wish.part = wr_param_value(params, "part")->text;
    WrImage *image = wr_image_read_wish(path, &wish, err);
    if (image && image->taken[0])
        wr_generate_note(job, "%s: took %s (%s= and part= take others)", path, image->taken,
                         channels_);
    if (image) wr_picture_note(path, image, job);
    return image;
}

void wr_picture_note(const char *path, const WrImage *image, const WrGenerateJob *job)
{
    if (image->note[0]) wr_generate_note(job, "%s: %s", path, image->note);
    if (image->filled)
        wr_generate_note(job, "%s: %lld missing values filled from their neighbours", path,
                         (long long)image->filled);
}

const WrImageLabel *wr_picture_label(const WrParams *params, const WrImage *image,
                                     const WrGenerateJob *job)
{
    const WrImageLabel *label = &image->label;
    const char *path = wr_param_value(params, "file")->text;
    if (wr_param_whole(params, "labels") == WR_LABELS_IGNORE) return NULL;
    if (label->refused[0])
        wr_generate_note(job, "%s: its label %s makes no sense and is not used", path,
                         label->refused);
    return label->kind == WR_LABEL_NONE && !label->ranged ? NULL : label;
}

/* False if a label of heights or normals declares the codes as numbers. */
static bool is_light(const WrParams *p, const WrImage *image, const WrGenerateJob *job)
{
    bool linear = wr_param_whole(p, "light") == LINEAR;
    const WrImageLabel *label = wr_picture_label(p, image, job);
    if (!label || !linear || image->type == WR_PIXEL_F32) return linear;
    wr_generate_note(job,
                     "%s: its label tells that it holds %s: its codes are taken as numbers, not as "
                     "light (labels=ignore takes them as light)",
                     wr_param_value(p, "file")->text,
                     label->kind >= WR_LABEL_NORMAL_UP ? "normals or slopes" : "heights");
    return false;
}

/* Value of each code of a picture of 8 or 16 bits; NULL for floats. Caller frees. */
static double *light_of_codes(const WrImage *image, bool linear, double *most)
{
    *most = image->type == WR_PIXEL_U8 ? 255.0 : image->type == WR_PIXEL_U16 ? 65535.0 : 0.0;
    if (*most == 0.0) return NULL;
    double *light = wr_alloc((size_t)*most + 1, sizeof *light);
    for (int k = 0; k <= (int)*most; k++)
        light[k] = linear ? wr_picture_light(k / *most) : k / *most;
    return light;
}

/* c[4]: red, green, blue, alpha */
static double pick(int channel, const double *c)
{
    if (channel >= RED && channel <= ALPHA) return c[channel - RED];
    if (channel == LARGEST) {
        double most = c[0] > c[1] ? c[0] : c[1];
        return most > c[2] ? most : c[2];
    }
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; /* Rec. 709 */
}

static void read_light(const WrImage *image, int channel, bool linear, WrSheet *sheet)
{
    double most, *light = light_of_codes(image, linear, &most);
    int n = image->channels, alpha = n == 2 ? 1 : n == 4 ? 3 : -1;
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        const float *pixel = image->data + k * (size_t)n;
        double c[4] = { 0.0, 0.0, 0.0, 1.0 };
        for (int a = 0; a < 3; a++) {
            double code = (double)pixel[n < 3 ? 0 : a];
            c[a] = light ? light[(int)rint(code * most)] : code;
        }
        if (alpha >= 0) c[3] = (double)pixel[alpha];
        sheet->z[k] = n < 3 && channel != ALPHA ? c[0] : pick(channel, c);
    }
    wr_free(light);
}

/* Subtracts a Gaussian blur of that width; preserves the mean. */
static bool high_pass(WrSheet *sheet, double sigma, const WrGenerateJob *job, WrError *err)
{
    const WrOpOptions options = { .pool = job->pool };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    double mean = 0.0;
    WrSheet wide = { .z = NULL };
    WrField *field = wr_sheet_field(sheet, err);
    WrField *blurred = field ? wr_op_run(wr_op_find("blur"), field, &sigma, &options, err) : NULL;
    bool good = blurred && wr_sheet_read(&wide, blurred, err);
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++)
        mean += sheet->z[k] / (double)count;
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++)
        sheet->z[k] += mean - wide.z[k];
    wr_sheet_fini(&wide);
    wr_field_free(field);
    wr_field_free(blurred);
    return good;
}

/* Numbers that are no light, such as elevations in metres, come out flat: what to do. t: least and most of the heights'
   shares of height=, 0..1; cut: values below low or above high. */
static void note_flat(const char *path, double least, double most, size_t cut, size_t count,
                      double darkest, double lightest, const WrGenerateJob *job)
{
    if (!(lightest > darkest)) return;
    if (2 * cut > count && (darkest < 0.0 || lightest > 1.0))
        wr_generate_note(job,
                         "%s: %zu of %zu values lie outside low and high and are cut (they go "
                         "from %g to %g): stretch=on takes their range",
                         path, cut, count, darkest, lightest);
    else if (most - least < FLAT)
        wr_generate_note(job,
                         "%s: its values go from %g to %g, which is nearly flat: stretch=on takes "
                         "their range",
                         path, darkest, lightest);
}

static void bring_to_heights(const WrParams *p, const char *path, WrSheet *sheet,
                             const WrGenerateJob *job)
{
    double low = wr_param_number(p, "low"), high = wr_param_number(p, "high");
    double power = 1.0 / wr_param_number(p, "gamma"), least = 1.0, most = 0.0, from, to;
    double height = wr_param_number(p, "height"), level = wr_param_number(p, "level");
    bool invert = wr_param_whole(p, "invert") == 1;
    wr_sheet_range(sheet, &from, &to);
    const bool stretch = wr_param_whole(p, "stretch") == 1;
    const double darkest = stretch ? from : 0.0, span = !stretch    ? 1.0
                                                        : to > from ? to - from
                                                                    : 1.0;
    size_t cut = 0;
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double t = ((sheet->z[k] - darkest) / span - low) / (high - low);
        if (!(t >= 0.0 && t <= 1.0)) cut++, t = t > 0.0 ? 1.0 : 0.0;
        if (t < least) least = t;
        if (t > most) most = t;
        if (power != 1.0) t = wr_pow(t, power);
        sheet->z[k] = level + height * (invert ? 1.0 - t : t);
    }
    note_flat(path, least, most, cut, count, from, to, job);
}

static bool check(const WrParams *p, const WrImage *image, const char *path, WrError *err)
{
    double low = wr_param_number(p, "low"), high = wr_param_number(p, "high");
    if (!(low < high))
        return wr_fail(err, "low=%g: must be below high=%g; invert=on makes dark high", low, high);
    if (wr_param_whole(p, "channel") == ALPHA && image->channels % 2 == 1)
        return wr_fail(err, "%s: channel=alpha: it has none", path);
    return true;
}

bool wr_picture_photo(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams p = { wr_params_photo, values };
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    const char *path = wr_param_value(&p, "file")->text;
    double sigma = wr_param_number(&p, "highpass");
    WrSheet sheet = { .z = NULL };
    WrImage *image = wr_picture_read(&p, "layer", (WrImageRequest){ 0 }, job, err);
    bool good = image && check(&p, image, path, err) &&
                wr_sheet_new(&sheet, image->width, image->height, wrap, err);
    if (good) {
        read_light(image, wr_param_whole(&p, "channel"), is_light(&p, image, job), &sheet);
        if (image->replaced > 0)
            wr_generate_note(job, "%s: %lld numbers that are none count as 0", path,
                             (long long)image->replaced);
    }
    wr_image_free(image);
    good = good && wr_picture_fit(&sheet, (WrSeamless)wr_param_whole(&p, "seamless"), job, err) &&
           (!(sigma > 0.0) || high_pass(&sheet, sigma, job, err));
    if (good) {
        bring_to_heights(&p, path, &sheet, job);
        good = wr_sheet_relief(&sheet, job, out, err);
    }
    wr_sheet_fini(&sheet);
    return good;
}
