/* Commands for textures of an object: colour, normalmap, roughness, metalness, gltf, colouring, grain. */
#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "image/gltf.h"
#include "image/image.h"
#include "scene/normal_map.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "shade/solid_texture.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct WrError WrError;
typedef struct WrImage WrImage;
typedef struct WrTextureSample WrTextureSample;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

#define WR_ARGS_REPEAT                                                                             \
    {                                                                                              \
        .name = "repeat", .type = WR_ARG_TEXT, .shape = "table|once|ru,rv", .check = check_repeat, \
        .help = "repeats along u and v; table: those of replicate; once: one. Left out, table"     \
    }
#define WR_ARGS_SHA256                                                                             \
    {                                                                                              \
        .name = "sha256", .type = WR_ARG_SHA256,                                                   \
        .help = "SHA-256 of the file; a file with other content is an error"                       \
    }

/* ---- arguments of a texture file ---- */

/* Print source and tiling of a picture: " FILE channel=... part=... sha256=... repeat=...". */
static void print_laid(const WrTextureSample *laid, bool named, WrText *text)
{
    const double ru = laid->ru, rv = laid->rv;
    if (named) wr_text_add(text, " "), wr_text_add_word(text, laid->path);
    wr_print_word("channel", laid->channel, text);
    wr_print_word("part", laid->part, text);
    if (*laid->sha256) wr_text_addf(text, " sha256=%s", laid->sha256);
    if (laid->own && ru == 1 && rv == 1) {
        wr_text_add(text, " repeat=once");
    } else if (laid->own) {
        wr_text_add(text, " repeat=");
        wr_text_add_number(text, ru);
        wr_text_add(text, ",");
        wr_text_add_number(text, rv);
    }
}

/* Parse the tiling of a picture: as the table, once, or a number of repeats. */
static bool repeat_parse(const char *text, WrTextureSample *repeat)
{
    const char *comma = strchr(text, ',');
    repeat->own = strcmp(text, "table") != 0;
    repeat->ru = repeat->rv = repeat->own ? 1 : 0;
    if (!repeat->own || strcmp(text, "once") == 0) return true;
    return comma && wr_number_parse(text, (size_t)(comma - text), &repeat->ru) &&
           wr_number_parse(comma + 1, strlen(comma + 1), &repeat->rv) && fabs(repeat->ru) <= 1e9 &&
           fabs(repeat->rv) <= 1e9;
}

static bool check_repeat(const void *ctx, const char *name, const char *value, WrError *err)
{
    WrTextureSample repeat;
    (void)ctx;
    if (repeat_parse(value, &repeat)) return true;
    return wr_fail(err, "%s=%.40s: must be table, once, or two numbers ru,rv, -1e9..1e9", name,
                   value);
}

/* Store the line's repeat= value; the words are not borrowed. */
static void take_repeat(const WrCall *call, WrTextureSample *laid)
{
    if (wr_call_given(call, "repeat")) repeat_parse(wr_call_arg(call, "repeat")->text, laid);
}

/* Set the source to another file; tiling as the table's, unless the line has repeat=. */
static void take_laid(WrCall *call, const char *name, WrTextureSample *laid)
{
    const char *hex = wr_call_arg(call, "sha256")->text;
    const WrImageRequest wish = wr_call_request(call);
    wr_texture_sample_fini(laid);
    if (!name) return;
    laid->path = wr_strdup(name);
    laid->channel = wr_strdup(wish.channel);
    laid->part = wr_strdup(wish.part);
    if (hex) memcpy(laid->sha256, hex, 64);
    take_repeat(call, laid);
}

/* The picture that a line names: while a document loads, its embedded one, else the file's. The caller frees it. Documents
   hold decoded pixels of their pictures, so they open without the original files, on any machine. */
static WrImage *find_laid(WrSession *session, WrCall *call, const char *name, int which,
                          WrError *err)
{
    if (session->loading) {
        const int object = session->state.document->scene->chosen;
        const WrImage *held = session->embedded ? session->embedded[object][which] : NULL;
        if (held) return wr_image_share(held);
        wr_fail(err, "the document refers to the picture %s but does not contain it", name);
        return NULL;
    }
    char *path = wr_session_input_path(session, name);
    WrImage *image = NULL;
    const WrImageRequest wish = wr_call_request(call);
    if (wr_session_check_sha256(call, path, err)) image = wr_input_image(path, &wish, err);
    if (image) wr_session_note_read(session, path, image);
    wr_free(path);
    return image;
}

/* Refuses arguments that belong to a file: the line names none, or with `off` removes it. */
static bool refuse_without(const WrCall *call, const char *const *names, bool off, WrError *err)
{
    while (*names && !wr_call_given(call, *names)) names++;
    if (!*names) return true;
    return off ? wr_fail(err, "%s= cannot be given with off", *names)
               : wr_fail(err, "%s= needs a file", *names);
}

/* ---- Texture maps of the object: colour and normals ---- */

#define LOOK 16384 /* pixels between two checks for cancellation */

/* ---- colour ---- */

/* A code 0..1 of sRGB as linear light. light: that of the 256 codes of 8 bits, which most pictures have; others need a power. */
static float decoded(const float light[256], float code)
{
    const int k = (int)(code * 255.0f + 0.5f);
    const bool is_code = k >= 0 && k < 256 && code == (float)k / 255.0f;
    return is_code ? light[k] : wr_srgb_decode(code);
}

/* Linear RGB, or one grey channel, without alpha; 8-bit and 16-bit values are decoded from sRGB. Shading works in linear
   light; decoding here, once per picture, leaves renderers without a colour conversion per lookup. Negative floats have no
   meaning as reflectance and become 0. */
static WrImage *linear_colour(const WrImage *from, WrError *err)
{
    int channels = from->channels < 3 ? 1 : 3;
    WrImage *to = wr_image_new(from->width, from->height, channels, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    size_t pixels = (size_t)from->width * (size_t)from->height;
    bool decode = from->type != WR_PIXEL_F32;
    float light[256];
    for (int k = 0; k < 256; k++) light[k] = wr_srgb_decode((float)k / 255.0f);
    for (size_t i = 0; i < pixels; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        for (int c = 0; c < channels; c++) {
            float x = from->data[i * (size_t)from->channels + (size_t)c];
            if (decode) x = decoded(light, x);
            to->data[i * (size_t)channels + (size_t)c] = x > 0 ? x : 0;
        }
    }
    return to;
}

static void print_colour_line(const WrScene *scene, bool named, WrText *text)
{
    if (!scene->colour || scene->colouring.count > 0) return;
    wr_text_add(text, "colour");
    print_laid(&scene->colour_laid, named, text);
    wr_text_add(text, "\n");
}

static void print_colour(const WrScene *scene, WrText *text)
{
    print_colour_line(scene, true, text);
}

/* print_NAME writes the line that recreates the state; print_NAME_content omits the path if a checksum identifies the file,
   so that equal content has equal text wherever the file lies (wr_print_identity). */
static void print_colour_content(const WrScene *scene, WrText *text)
{
    print_colour_line(scene, !*scene->colour_laid.sha256, text);
}

/* Change the settings of the present picture by a line without a file. */
static bool change_colour(WrSession *session, const WrCall *call, WrError *err)
{
    static const char *const of_file[] = { "layer", "part", "sha256", NULL };
    const WrScene *now = session->state.document->scene;
    if (!now->colour || now->colouring.count > 0)
        return wr_fail(err, "the object has no colour picture: name a file");
    if (!refuse_without(call, of_file, false, err)) return false;
    WrScene *scene = wr_scene_clone(now);
    take_repeat(call, &scene->colour_laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_colour(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const of_colour[] = { "sha256", "repeat", "layer", "part", NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && strcmp(name, "off") == 0;
    if (!name) return change_colour(session, call, err);
    if (off && !refuse_without(call, of_colour, true, err)) return false;
    WrImage *image = off ? NULL : find_laid(session, call, name, WR_OBJECT_COLOUR, err);
    WrImage *colour = image ? linear_colour(image, err) : NULL;
    wr_image_free(image);
    if (!off && !colour) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_drop_colour(scene);
    scene->colour = colour;
    take_laid(call, off ? NULL : name, &scene->colour_laid);
    wr_session_replace_scene(session, scene);
    return true;
}

/* ---- normals ---- */

static const char *const spaces[] = { "tangent", "object", NULL };
static const char *const greens[] = { "auto", "up", "down", NULL };
static const char *const channel_counts[] = { "auto", "2", "3", NULL };

static void print_normals_line(const WrScene *scene, bool named, WrText *text)
{
    const WrNormalMap *map = &scene->normals;
    if (!map->image) return;
    wr_text_add(text, "normalmap");
    print_laid(&map->laid, named, text);
    wr_text_addf(text, " space=%s green=%s", spaces[map->object],
                 greens[map->green_down ? WR_GREEN_DOWN : WR_GREEN_UP]);
    if (!map->object)
        wr_text_addf(text, " frame=%s channels=%d", wr_normal_frame_names[map->frame],
                     map->channels);
    wr_text_add(text, " strength=");
    wr_text_add_number(text, map->strength);
    if (map->combine != WR_COMBINE_SLOPES)
        wr_text_addf(text, " combine=%s", wr_combine_names[map->combine]);
    wr_text_add(text, "\n");
}

static void print_normals(const WrScene *scene, WrText *text)
{
    print_normals_line(scene, true, text);
}

static void print_normals_content(const WrScene *scene, WrText *text)
{
    print_normals_line(scene, !*scene->normals.laid.sha256, text);
}

static void note_codes(WrText *text, const WrImage *file, const WrNormalMapReport *report)
{
    const double last = wr_pixel_type_max(file->type);
    wr_text_addf(text, "%dx%d, %d channels of ", file->width, file->height, report->channels);
    if (last > 0) wr_text_addf(text, "%d bits", last > 255 ? 16 : 8);
    else
        wr_text_addf(text, "floats, %s",
                     report->own ? "the vectors' own (coding=signed)"
                                 : "coded in 0..1 (coding=unit)");
    if (report->channels == 2) wr_text_add(text, ", z rebuilt");
    if (report->centred) wr_text_addf(text, "; code %d stands for 0", (int)(last + 1) / 2);
}

/* Note the interpretation of a normal map and possible faults in it. */
static void note_normals(WrSession *session, const char *name, const WrImage *file, WrGreen asked,
                         bool labelled, const WrNormalMapReport *report)
{
    WrText text = { 0 };
    note_codes(&text, file, report);
    wr_text_addf(&text, "; green %s%s", report->green_down ? "down" : "up",
                 asked != WR_GREEN_AUTO ? ""
                 : labelled             ? ", as its label says"
                 : report->undecided ? ", undecided: its slopes fit either; green=down takes it so"
                                     : ", found from its slopes");
    if (report->away)
        wr_text_addf(&text, "; %lld texels that look away were brought to the horizon",
                     (long long)report->away);
    if (report->converted)
        wr_text_add(&text, "; its mean is that of a picture that went through an sRGB conversion: "
                           "normals are data, and would be bent");
    wr_session_note(session, "%s: %s", name, wr_text_get(&text));
    wr_text_fini(&text);
}

/* Read the normal map of a file as the line states. */
static WrImage *read_normals(WrSession *session, const WrCall *call, const char *name,
                             const WrImage *file, WrNormalMap *map, WrError *err)
{
    const int channels = wr_call_choice(call, "channels");
    const WrGreen asked = (WrGreen)wr_call_choice(call, "green");
    const WrCoding coding = (WrCoding)wr_call_choice(call, "coding");
    const bool labelled = file->label.green != 0;
    WrGreen green = asked;
    WrNormalMapReport report;
    if (green == WR_GREEN_AUTO && labelled)
        green = file->label.green < 0 ? WR_GREEN_DOWN : WR_GREEN_UP;
    WrImage *image =
        map->object
            ? wr_normal_map_read_object(file, green == WR_GREEN_DOWN, coding, &report, err)
            : wr_normal_map_decode(file, green, channels ? channels + 1 : 0, coding, &report, err);
    if (!image) return NULL;
    map->channels = report.channels;
    map->green_down = report.green_down;
    note_normals(session, name, file, map->object ? WR_GREEN_UP : asked, labelled, &report);
    return image;
}

/* Set the normal map of a line with a file; settings of the earlier map are not kept. While a document loads, the vectors
   were decoded before they were saved: green and channels only record the original choice. */
static bool take_normals(WrSession *session, WrCall *call, const char *name, WrNormalMap *map,
                         WrError *err)
{
    const bool object = wr_call_choice(call, "space") == 1;
    if (object && wr_call_given(call, "channels"))
        return wr_fail(
            err, "channels= needs space=tangent; object-space maps always use three channels");
    if (object && wr_call_given(call, "frame"))
        return wr_fail(err, "frame= needs space=tangent; object-space maps have no tangent frame");
    WrImage *file = find_laid(session, call, name, WR_OBJECT_NORMALS, err), *image = NULL;
    map->object = object;
    map->frame = WR_FRAME_AUTO;
    map->combine = WR_COMBINE_SLOPES;
    map->strength = 1;
    if (file && session->loading) {
        map->green_down = wr_call_choice(call, "green") == WR_GREEN_DOWN;
        map->channels = wr_call_choice(call, "channels") == 1 ? 2 : 3;
        image = wr_normal_map_share(file, object, err);
    } else if (file) {
        image = read_normals(session, call, name, file, map, err);
    }
    wr_image_free(file);
    if (!image) return false;
    wr_image_free(map->image);
    map->image = image;
    take_laid(call, name, &map->laid);
    return true;
}

/* Change the meaning of the green channel. */
static bool change_green(const WrCall *call, WrNormalMap *map, WrError *err)
{
    const int green = wr_call_choice(call, "green");
    if (!wr_call_given(call, "green")) return true;
    if (green == WR_GREEN_AUTO) return wr_fail(err, "green=auto: needs a file");
    if ((green == WR_GREEN_DOWN) == map->green_down) return true;
    WrImage *turned = wr_normal_map_turned(map->image, err);
    if (!turned) return false;
    wr_image_free(map->image);
    map->image = turned;
    map->green_down = !map->green_down;
    return true;
}

/* Convert the present vectors to another space; vectors below the tangent plane are moved to its horizon. Tangent space has z
   > 0: a vector that points below the surface has no slope. */
static bool change_space(WrSession *session, const WrCall *call, WrNormalMap *map, WrError *err)
{
    const bool object = wr_call_choice(call, "space") == 1;
    int64_t away;
    if (!wr_call_given(call, "space") || object == map->object) return true;
    WrImage *taken =
        object ? wr_image_share(map->image) : wr_normal_map_raised(map->image, &away, err);
    if (!taken) return false;
    if (!object && away)
        wr_session_note(session,
                        "%lld normals that point below the surface were clamped to the horizon",
                        (long long)away);
    wr_image_free(map->image);
    map->image = taken;
    map->object = object;
    map->frame = WR_FRAME_AUTO;
    return true;
}

/* Change the settings of the present map by a line without a file. */
static bool change_normals(WrSession *session, const WrCall *call, WrNormalMap *map, WrError *err)
{
    static const char *const of_file[] = { "channels", "coding", "layer", "part", "sha256", NULL };
    if (!map->image) return wr_fail(err, "the object has no normal map: name a file");
    if (!refuse_without(call, of_file, false, err)) return false;
    if (!change_green(call, map, err) || !change_space(session, call, map, err)) return false;
    if (map->object && wr_call_given(call, "frame"))
        return wr_fail(err, "frame=: this is an object-space map, which has no tangent frame");
    take_repeat(call, &map->laid);
    return true;
}

static bool run_normals(WrSession *session, WrCall *call, WrError *err)
{
    static const char *const of_map[] = { "space",  "frame",    "green",   "channels",
                                          "coding", "strength", "combine", "repeat",
                                          "layer",  "part",     "sha256",  NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && (strcmp(name, "off") == 0 || strcmp(name, "none") == 0);
    if (off && !refuse_without(call, of_map, true, err)) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrNormalMap *map = &scene->normals;
    bool good = true;
    if (off) {
        wr_image_free(map->image);
        wr_texture_sample_fini(&map->laid);
        *map = (WrNormalMap){ 0 };
    } else {
        good = name ? take_normals(session, call, name, map, err)
                    : change_normals(session, call, map, err);
    }
    if (good && wr_call_given(call, "frame"))
        map->frame = (WrNormalFrame)wr_call_choice(call, "frame");
    if (good && wr_call_given(call, "strength")) map->strength = wr_call_number(call, "strength");
    if (good && wr_call_given(call, "combine"))
        map->combine = (WrCombine)wr_call_choice(call, "combine");
    if (good) wr_session_replace_scene(session, scene);
    else wr_scene_free(scene);
    return good;
}

/* ---- rows ---- */

static const char *const off_words[] = { "off", NULL }, *const none_words[] = { "off", "none",
                                                                                NULL };

static const WrArgSpec args_colour[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = off_words,
      .help = "a picture over u and v, or off (a file of that name is ./off); left out, the "
              "present picture, whose repeat= may change" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

static const WrArgSpec args_normals[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = none_words,
      .help = "a picture of normals, or off (none means off too; a file of that name is ./off); "
              "left out, the present map, whose strength, combine, repeat, space, frame and green "
              "may change" },
    { .name = "space",
      .type = WR_ARG_CHOICE,
      .words = spaces,
      .fallback_text = "tangent",
      .help = "tangent: x along u, y along v, z up; object: along the object's axes. Without a "
              "file, how the present vectors are interpreted" },
    { .name = "frame",
      .type = WR_ARG_CHOICE,
      .words = wr_normal_frame_names,
      .fallback_text = "auto",
      .help = "tangent frame. gradient: slopes of heights over a cell of one unit, as the table's; "
              "mikk: unit vectors of MikkTSpace, as other programs bake; lecture: unit vectors "
              "along Pu and Pv; auto: mikk on a mesh, else gradient" },
    { .name = "green",
      .type = WR_ARG_CHOICE,
      .words = greens,
      .fallback_text = "auto",
      .help = "direction of the second channel: up the picture, down, or auto: from the file's "
              "metadata or the slopes" },
    { .name = "channels",
      .type = WR_ARG_CHOICE,
      .words = channel_counts,
      .fallback_text = "auto",
      .help =
          "channels to read. 3: all; 2: z is computed from x and y; auto: all that the file has" },
    { .name = "coding",
      .type = WR_ARG_CHOICE,
      .words = wr_codings,
      .fallback_text = "auto",
      .help = "coding of float pictures. unit: 0..1 stands for -1..1; signed: the vectors "
              "themselves; auto: the one whose vectors are nearer to length 1" },
    { .name = "strength",
      .type = WR_ARG_NUMBER,
      .low = -100,
      .high = 100,
      .help = "factor of its slopes; for a new map 1" },
    { .name = "combine",
      .type = WR_ARG_CHOICE,
      .words = wr_combine_names,
      .fallback_text = "slopes",
      .help = "combination with the table's relief. slopes: both are added, as heights are; "
              "reoriented: the relief's normal is rotated with the map's, as other programs "
              "combine a detail map; surface: as reoriented, but the relief is flatter where the "
              "map's slope stretches it, like heights along the map's normal" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

const WrCommand wr_command_colour = {
    .name = "colour",
    .kind = WR_CLASS_SCENE,
    .args = args_colour,
    .run = run_colour,
    .print = print_colour,
    .print_content = print_colour_content,
    .of_object = true,
    .help = "set a colour picture on the surface",
    .details = "8-bit and 16-bit pictures are decoded from sRGB, float pictures are linear; alpha "
               "is ignored. Beyond its edges it continues as the table does. With dials aa=filter "
               "and aa=moments each pixel shows the mean of the picture over its area. It is saved "
               "in the document.",
    .example = "colour peel.png repeat=once"
};

const WrCommand wr_command_normalmap = {
    .name = "normalmap",
    .kind = WR_CLASS_SCENE,
    .args = args_normals,
    .run = run_normals,
    .print = print_normals,
    .print_content = print_normals_content,
    .of_object = true,
    .help = "set a normal map on the surface",
    .details = "Its slopes are added to those of the table, or combined by combine=. The map that "
               "`export normal` writes for a table with cell=1,1 has the same effect as the table. "
               "A normal map is data and never colour-converted: 8-bit and 16-bit codes mean 2 c/M "
               "- 1, floats depend on coding=. If most texels are 128,128 (32768 in 16 bits), that "
               "code means 0; a note reports the choice. Beyond its edges it continues as the "
               "table does. It is saved in the document.",
    .example = "normalmap rivets.png green=down strength=1"
};

/* ---- The commands roughness and metalness: maps that replace the material's numbers ---- */

/* Default channel: a glTF picture packs roughness in G and metalness in B; a grey picture has only one. */
static int channel_of(const WrImage *from, WrFacetKind kind, bool asked)
{
    if (asked || from->channels < 3) return 0;
    return kind == WR_FACET_ROUGHNESS ? 1 : 2;
}

/* Channel values 0..1 of the file, without colour conversion. */
static WrImage *numbers_of(const WrImage *from, int channel, WrError *err)
{
    WrImage *to = wr_image_new(from->width, from->height, 1, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    const size_t pixels = (size_t)from->width * (size_t)from->height;
    for (size_t i = 0; i < pixels; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        const float x = from->data[i * (size_t)from->channels + (size_t)channel];
        to->data[i] = x > 0 ? x < 1 ? x : 1 : 0;
    }
    return to;
}

static const char *const verbs[WR_FACET_KINDS] = { "roughness", "metalness" };

static void print_facets(const WrScene *scene, int kind, bool named, WrText *text)
{
    const WrFacetMap *map = &scene->facets[kind];
    if (!map->image) return;
    wr_text_add(text, verbs[kind]);
    print_laid(&map->laid, named, text);
    wr_text_add(text, "\n");
}

static void print_roughness(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_ROUGHNESS, true, text);
}

static void print_roughness_content(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_ROUGHNESS, !*scene->facets[WR_FACET_ROUGHNESS].laid.sha256, text);
}

static void print_metalness(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_METALNESS, true, text);
}

static void print_metalness_content(const WrScene *scene, WrText *text)
{
    print_facets(scene, WR_FACET_METALNESS, !*scene->facets[WR_FACET_METALNESS].laid.sha256, text);
}

/* Change the settings of the present picture by a line without a file. */
static bool change(WrSession *session, const WrCall *call, WrFacetKind kind, WrError *err)
{
    static const char *const of_file[] = { "layer", "part", "sha256", NULL };
    const WrScene *now = session->state.document->scene;
    if (!now->facets[kind].image)
        return wr_fail(err, "the object has no picture of %s: name a file", verbs[kind]);
    if (!refuse_without(call, of_file, false, err)) return false;
    WrScene *scene = wr_scene_clone(now);
    take_repeat(call, &scene->facets[kind].laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static WrImage *read_numbers(WrSession *session, WrCall *call, const char *name, WrFacetKind kind,
                             WrError *err)
{
    const int which = kind == WR_FACET_ROUGHNESS ? WR_OBJECT_ROUGHNESS : WR_OBJECT_METALNESS;
    WrImage *file = find_laid(session, call, name, which, err);
    const bool asked = session->loading || wr_call_given(call, "layer");
    WrImage *numbers = file ? numbers_of(file, channel_of(file, kind, asked), err) : NULL;
    wr_image_free(file);
    return numbers;
}

static bool run(WrSession *session, WrCall *call, WrFacetKind kind, WrError *err)
{
    static const char *const of_map[] = { "sha256", "repeat", "layer", "part", NULL };
    const WrArg *file = wr_call_arg(call, "FILE|off");
    const char *name = file->given ? file->text : NULL;
    const bool off = name && strcmp(name, "off") == 0;
    if (!name) return change(session, call, kind, err);
    if (off && !refuse_without(call, of_map, true, err)) return false;
    WrImage *image = off ? NULL : read_numbers(session, call, name, kind, err);
    if (!off && !image) return false;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrFacetMap *map = &scene->facets[kind];
    wr_image_free(map->image);
    map->image = image;
    take_laid(call, off ? NULL : name, &map->laid);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_roughness(WrSession *session, WrCall *call, WrError *err)
{
    return run(session, call, WR_FACET_ROUGHNESS, err);
}

static bool run_metalness(WrSession *session, WrCall *call, WrError *err)
{
    return run(session, call, WR_FACET_METALNESS, err);
}

static const WrArgSpec args_facet[] = {
    { .name = "FILE|off",
      .type = WR_ARG_PATH,
      .positional = true,
      .words = off_words,
      .help = "a picture over u and v, or off (a file of that name is ./off); left out, the "
              "present picture, whose repeat= may change" },
    WR_ARGS_REPEAT,
    WR_ARGS_OF_FILE,
    WR_ARGS_SHA256,
    { 0 }
};

const WrCommand wr_command_roughness = {
    .name = "roughness",
    .kind = WR_CLASS_SCENE,
    .args = args_facet,
    .run = run_roughness,
    .print = print_roughness,
    .print_content = print_roughness_content,
    .of_object = true,
    .help = "set a roughness map",
    .details = "Replaces the roughness of the material and of a solid texture. Its values are "
               "data, 0 smooth and 1 rough, and never colour-converted. Of a picture with three "
               "channels G is used, as in glTF, unless channel= is given. Beyond its edges it "
               "continues as the table does. With dials aa=filter and aa=moments each pixel shows "
               "the mean over its area. It is saved in the document.",
    .example = "roughness worn.png repeat=once"
};

const WrCommand wr_command_metalness = {
    .name = "metalness",
    .kind = WR_CLASS_SCENE,
    .args = args_facet,
    .run = run_metalness,
    .print = print_metalness,
    .print_content = print_metalness_content,
    .of_object = true,
    .help = "set a metalness map",
    .details = "Replaces the metalness of the material, for model ggx. Like `roughness`, but of "
               "three channels B is used: one packed picture of glTF serves for both.",
    .example = "metalness worn.png repeat=once"
};

/* ---- The command gltf: load the material of a glTF file for the active object ---- */

/* Run another command's line as a part of this one. The inner command runs within the outer one's step (session->depth): one
   undo reverts the whole material. */
static bool run_line(WrSession *session, const WrText *line, WrError *err)
{
    WrCall *call = NULL;
    const bool good = wr_call_parse(wr_text_get(line), false, &call, err) &&
                      call->command->run(session, call, err);
    wr_call_free(call);
    return good;
}

static bool take_numbers(WrSession *session, const WrGltfMaterial *look, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line,
                "material model=ggx energy=kept diffuse=1 specular=1 ior=1.5 tint=0 colour=");
    for (int k = 0; k < 3; k++) {
        if (k) wr_text_add(&line, ",");
        wr_text_add_number(&line, look->colour[k]);
    }
    wr_text_add(&line, " metalness=");
    wr_text_add_number(&line, look->metalness);
    wr_text_add(&line, " roughness=");
    wr_text_add_number(&line, look->roughness);
    const bool good = run_line(session, &line, err);
    wr_text_fini(&line);
    return good;
}

/* Counts for the note: used and unused parts of the file. */
typedef struct GltfReport {
    WrText taken, left;
} GltfReport;

static void list(WrText *text, const char *part)
{
    if (text->length > 0) wr_text_add(text, ", ");
    wr_text_add(text, part);
}

/* Load a picture of the file by running another command; -1: no picture, which removes the present one. An unreadable
   picture is skipped with a note. FILE#N names picture N inside a glTF file, so the line of the step can be repeated from the
   file alone. */
static bool take_picture(WrSession *session, const char *file, int image, const char *verb,
                         const char *rest, const char *part, GltfReport *report, WrError *err)
{
    WrText line = { 0 }, name = { 0 };
    WrError why = { "" };
    wr_text_addf(&name, "%s#%d", file, image);
    wr_text_addf(&line, "%s ", verb);
    if (image < 0) wr_text_add(&line, "off");
    else wr_text_add_word(&line, wr_text_get(&name));
    if (image >= 0) wr_text_add(&line, rest);
    const bool good = run_line(session, &line, &why);
    wr_text_fini(&line);
    wr_text_fini(&name);
    if (!good && wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (!good && image < 0) return wr_fail(err, "%s", wr_error_message(&why));
    if (good && image >= 0) list(&report->taken, part);
    if (!good) {
        WrText both = { 0 };
        wr_text_addf(&both, "the picture of %s (%s)", part, why.text);
        list(&report->left, wr_text_get(&both));
        wr_text_fini(&both);
    }
    return good || take_picture(session, file, -1, verb, "", part, report, err);
}

/* Note roughness and metalness factors that a picture replaces. */
static void note_factors(const WrScene *scene, const WrGltfMaterial *look, GltfReport *report)
{
    const double factor[WR_FACET_KINDS] = {
        [WR_FACET_ROUGHNESS] = look->roughness, [WR_FACET_METALNESS] = look->metalness
    };
    static const char *const names[WR_FACET_KINDS] = {
        [WR_FACET_ROUGHNESS] = "roughness", [WR_FACET_METALNESS] = "metalness"
    };
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        if (!scene->facets[k].image || factor[k] == 1) continue;
        WrText words = { 0 };
        wr_text_addf(&words, "the factor ");
        wr_text_add_number(&words, factor[k]);
        wr_text_addf(&words, " of its picture of %s", names[k]);
        list(&report->left, wr_text_get(&words));
        wr_text_fini(&words);
    }
}

static bool take_pictures(WrSession *session, const char *file, const WrGltfMaterial *look,
                          GltfReport *report, WrError *err)
{
    WrText strength = { 0 };
    /* a factor of 0 cancels the picture */
    const int rough = look->roughness > 0 ? look->facets : -1;
    const int metal = look->metalness > 0 ? look->facets : -1;
    wr_text_add(&strength, " repeat=once space=tangent green=up strength=");
    wr_text_add_number(&strength, look->normal_scale);
    const bool good =
        take_picture(session, file, look->base, "colour", " repeat=once", "colours", report, err) &&
        take_picture(session, file, rough, "roughness", " repeat=once", "roughness", report, err) &&
        take_picture(session, file, metal, "metalness", " repeat=once", "metalness", report, err) &&
        take_picture(session, file, look->normal, "normalmap", wr_text_get(&strength), "normals",
                     report, err);
    wr_text_fini(&strength);
    return good;
}

static void note(WrSession *session, const char *path, const WrGltfMaterial *look,
                 const GltfReport *report)
{
    WrText text = { 0 };
    char shown[WR_EXCERPT_SIZE];
    wr_text_addf(&text, "%s: material %d of %d", path, look->index + 1, look->count);
    if (look->name[0]) wr_text_addf(&text, " \"%s\"", wr_excerpt(look->name, shown));
    wr_text_add(&text, ": its numbers");
    if (report->taken.length > 0)
        wr_text_addf(&text, ", and pictures of %s", wr_text_get(&report->taken));
    WrText left = { 0 };
    if (report->left.length > 0) list(&left, wr_text_get(&report->left));
    if (look->left[0]) list(&left, look->left);
    if (look->alpha != 1) list(&left, "the opacity of its colour");
    if (look->count > 1) list(&left, "other materials: an object has one (part= takes another)");
    wr_text_addf(&text, left.length > 0 ? "; not taken: %s" : "%s", wr_text_get(&left));
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&left);
    wr_text_fini(&text);
}

static bool take(WrSession *session, const char *name, const char *path, const WrGltfMaterial *look,
                 WrError *err)
{
    GltfReport report = { 0 };
    WrScene *before = wr_scene_clone(session->state.document->scene);
    const bool good =
        take_numbers(session, look, err) && take_pictures(session, name, look, &report, err);
    if (good) {
        note_factors(session->state.document->scene, look, &report);
        note(session, path, look, &report);
        wr_scene_free(before);
    } else {
        wr_session_replace_scene(session, before);
    }
    wr_text_fini(&report.taken);
    wr_text_fini(&report.left);
    return good;
}

/* Prints nothing: the lines of material, colour and so on hold the result. */
static void print_gltf(const WrScene *scene, WrText *text)
{
    (void)scene, (void)text;
}

static bool run_gltf(WrSession *session, WrCall *call, WrError *err)
{
    WrGltfMaterial look;
    if (session->loading) return wr_fail(err, "gltf cannot be in a document: it opens files");
    const char *name = wr_call_arg(call, "FILE")->text;
    const char *part = wr_call_given(call, "part") ? wr_call_arg(call, "part")->text : NULL;
    char *path = wr_session_input_path(session, name);
    const bool good = wr_session_check_sha256(call, path, err) &&
                      wr_gltf_read_material(path, part, &look, err) &&
                      take(session, name, path, &look, err);
    wr_free(path);
    return good;
}

static const WrArgSpec args_gltf[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a .gltf or .glb file" },
    { .name = "part",
      .type = WR_ARG_NAME,
      .shape = "N or NAME",
      .help = "name or number of the material; left out, that of the first triangles" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; a file with other content is an error" },
    { 0 }
};

const WrCommand wr_command_gltf = {
    .name = "gltf",
    .kind = WR_CLASS_SCENE,
    .args = args_gltf,
    .run = run_gltf,
    .print = print_gltf,
    .of_object = true,
    .help = "use the material of a glTF file",
    .details = "Base colour, metalness, roughness and strength of the normal map are copied to the "
               "object's material, of model ggx. Its pictures of colour, normals, roughness (G) "
               "and metalness (B), from the file or beside it, are set as by `colour`, "
               "`normalmap`, `roughness` and `metalness`, with repeat=1,1; their names there are "
               "FILE.glb#N, where N counts the file's images from 0. A note lists unused parts.",
    .example = "gltf helmet.glb"
};

/* ---- The command colouring ---- */

/* The command colouring: a picture coloured by height, slope and cavity, computed again when one of its inputs has
   changed. */

#define FORM_SIDE_MAX 512 /* texels: terrain patches are smooth, more adds no detail */
#define FORM_SIDE_MIN 64

enum { FORM_RAMP, FORM_OFF, COLOURING_FORMS };

/* ---- the picture --------------------------------------------------------------------------------- */

/* Terrain patches that supply the heights; NULL: the table does. */
static const WrPatches *form_of(const WrScene *object)
{
    const bool form =
        object->colouring.of == WR_HEIGHT_COLORMAP_FORM && object->shape.kind == WR_SURFACE_terrain;
    return form && object->triangles ? object->triangles->patches : NULL;
}

static uint64_t key_of(const WrSession *session, const WrScene *object)
{
    const WrDocument *document = session->state.document;
    const int layer = wr_layer_named(document, object->layer);
    uint64_t key, height;
    if (form_of(object)) return object->triangles->key | 1;
    key = layer >= 0 ? wr_layer_key(document, layer)
                     : wr_field_key(wr_document_composite(document, session->options.pool));
    memcpy(&height, &object->height, sizeof height);
    return (key * 0x9e3779b97f4a7c15U ^ (object->colouring.steep ? height : 0)) | 1;
}

static WrImage *made_by_table(const WrSession *session, const WrScene *object, WrError *err)
{
    const WrDocument *document = session->state.document;
    const int layer = wr_layer_named(document, object->layer);
    WrField *own =
        layer >= 0 ? wr_document_layer_alone(document, layer, session->options.pool) : NULL;
    const WrField *field = own ? own : wr_document_composite(document, session->options.pool);
    WrImage *made = wr_height_colormap_table(&object->colouring, field, object->height, err);
    wr_field_free(own);
    return made;
}

static int side_of(int size)
{
    return size < FORM_SIDE_MIN ? FORM_SIDE_MIN : size > FORM_SIDE_MAX ? FORM_SIDE_MAX : size;
}

static WrImage *made_by_form(const WrSession *session, const WrScene *object, WrError *err)
{
    const WrField *like = session->state.document->layers[0].heights;
    return wr_height_colormap_bake_terrain(&object->colouring, form_of(object),
                                           object->shape.value[2], side_of(wr_field_width(like)),
                                           side_of(wr_field_height(like)), err);
}

bool wr_height_colormap_lags(const WrSession *session, const WrScene *object)
{
    return object->colouring.count > 0 && object->colouring.key != key_of(session, object);
}

bool wr_height_colormap_make(const WrSession *session, WrScene *object, WrError *err)
{
    const bool form = form_of(object) != NULL;
    WrImage *made = form ? made_by_form(session, object, err) : made_by_table(session, object, err);
    if (!made) return false;
    wr_image_free(object->colour);
    wr_texture_sample_fini(&object->colour_laid);
    object->colour = made;
    object->colour_laid = (WrTextureSample){ .own = form, .ru = form, .rv = form };
    object->colouring.key = key_of(session, object);
    return true;
}

/* ---- the command --------------------------------------------------------------------------------- */

static void print_rgb(const double rgb[3], WrText *text)
{
    for (int c = 0; c < 3; c++) {
        if (c > 0) wr_text_add(text, ",");
        wr_text_add_number(text, rgb[c]);
    }
}

static void print_colouring(const WrScene *scene, WrText *text)
{
    const WrHeightColormap *own = &scene->colouring;
    if (own->count == 0) return;
    wr_text_add(text, "colouring ramp stops=");
    for (int i = 0; i < own->count; i++) {
        if (i > 0) wr_text_add(text, ";");
        wr_text_add_number(text, own->stops[i].height);
        wr_text_add(text, ",");
        print_rgb(own->stops[i].rgb, text);
    }
    if (own->steep) {
        wr_text_add(text, " steep=");
        print_rgb(own->steep_rgb, text);
        wr_text_add(text, " slope=");
        wr_text_add_number(text, own->slope[0]);
        wr_text_add(text, ",");
        wr_text_add_number(text, own->slope[1]);
    }
    if (own->hollow) {
        wr_text_add(text, " cavity=");
        print_rgb(own->hollow_rgb, text);
        wr_text_add(text, " depth=");
        wr_text_add_number(text, own->depth[0]);
        wr_text_add(text, ",");
        wr_text_add_number(text, own->depth[1]);
        wr_text_add(text, " within=");
        wr_text_add_number(text, own->within);
    }
    wr_text_addf(text, " of=%s\n", wr_height_colormap_names[own->of]);
}

static bool take_stops(const WrArg *list, WrHeightColormap *to, WrError *err)
{
    for (int i = 0; i < list->rows; i++) {
        const double *row = list->numbers + 4 * (size_t)i;
        if (i > 0 && row[0] < row[-4])
            return wr_fail(err, "stop %d is at %g, below the one before it: stops must rise", i + 1,
                           row[0]);
        to->stops[i] = (WrStop){ row[0], { row[1], row[2], row[3] } };
    }
    to->count = list->rows;
    return true;
}

static bool take_hollows(const WrCall *call, WrHeightColormap *to, WrError *err)
{
    if (wr_call_given(call, "cavity")) {
        to->hollow = true;
        memcpy(to->hollow_rgb, wr_call_arg(call, "cavity")->numbers, sizeof to->hollow_rgb);
    }
    if (wr_call_given(call, "depth"))
        memcpy(to->depth, wr_call_arg(call, "depth")->numbers, sizeof to->depth);
    if (wr_call_given(call, "within")) to->within = wr_call_number(call, "within");
    if (to->depth[1] < to->depth[0])
        return wr_fail(err, "depth=%g,%g: the second must not be less", to->depth[0], to->depth[1]);
    return true;
}

static bool take_ramp(const WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    WrHeightColormap *to = &scene->colouring;
    const bool terrain = scene->shape.kind == WR_SURFACE_terrain;
    if (to->count == 0) {
        wr_height_colormap_default(to);
        to->of = terrain ? WR_HEIGHT_COLORMAP_FORM : WR_HEIGHT_COLORMAP_TABLE;
    }
    if (wr_call_given(call, "stops") && !take_stops(wr_call_arg(call, "stops"), to, err))
        return false;
    if (wr_call_given(call, "steep")) {
        to->steep = true;
        memcpy(to->steep_rgb, wr_call_arg(call, "steep")->numbers, sizeof to->steep_rgb);
    }
    if (wr_call_given(call, "slope"))
        memcpy(to->slope, wr_call_arg(call, "slope")->numbers, sizeof to->slope);
    if (to->slope[1] < to->slope[0])
        return wr_fail(err, "slope=%g,%g: the second must not be less", to->slope[0], to->slope[1]);
    if (!take_hollows(call, to, err)) return false;
    if (wr_call_given(call, "of")) to->of = (WrHeightColormapOf)wr_call_choice(call, "of");
    if (to->of == WR_HEIGHT_COLORMAP_FORM && !terrain && !session->loading)
        return wr_fail(err, "of=form: only a terrain has one (`surface terrain`)");
    to->key = 0;
    return true;
}

static bool run_colouring(WrSession *session, WrCall *call, WrError *err)
{
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (call->form == FORM_OFF) {
        if (scene->colouring.count > 0) wr_scene_drop_colour(scene);
    } else if (!take_ramp(session, call, scene, err)) {
        wr_scene_free(scene);
        return false;
    }
    wr_session_replace_scene(session, scene);
    return true;
}

static const WrComponent stop_parts[] = { { "height", -1e30, 1e30, false },
                                          { "r", 0, 1e6, false },
                                          { "g", 0, 1e6, false },
                                          { "b", 0, 1e6, false } };

static const char *const of_words[] = { "form", "table", NULL };
_Static_assert(WR_LENGTH(of_words) == WR_COLOURINGS + 1, "a word for each");

WR_ROWS(colouring_forms);
static const WrForm colouring_forms[] = {
    [WR_ROW(
        FORM_RAMP)] = { .name = "ramp",
                        .help = "a gradient of colours by height. Only given arguments change; at "
                                "first water, sand, meadows, rock and snow over 0..1",
                        .args = { { .name = "stops",
                                    .type = WR_ARG_LIST,
                                    .components = 4,
                                    .parts = stop_parts,
                                    .rows_low = 1,
                                    .rows_high = WR_STOPS_MAX,
                                    .shape = "height,r,g,b;...",
                                    .help = "rising heights, in units of the table or the "
                                            "terrain's picture, with their colours; two stops at "
                                            "one height make a step" },
                                  { .name = "steep",
                                    .type = WR_ARG_TUPLE,
                                    .components = 3,
                                    .low = 0,
                                    .high = 1e6,
                                    .help = "the colour of steep places" },
                                  { .name = "slope",
                                    .type = WR_ARG_TUPLE,
                                    .components = 2,
                                    .low = 0,
                                    .high = 90,
                                    .help = "slopes at which it begins and is complete, in "
                                            "degrees; at first 30,45" },
                                  { .name = "cavity",
                                    .type = WR_ARG_TUPLE,
                                    .components = 3,
                                    .low = 0,
                                    .high = 1e6,
                                    .help =
                                        "colour of hollows: places below the mean around them" },
                                  { .name = "depth",
                                    .type = WR_ARG_TUPLE,
                                    .components = 2,
                                    .low = 0,
                                    .high = 1e30,
                                    .help = "depths below the mean at which it begins and is "
                                            "complete, in heights; at first 0.01,0.1" },
                                  { .name = "within",
                                    .type = WR_ARG_NUMBER,
                                    .low = 0.05,
                                    .high = 512,
                                    .unit = "texels",
                                    .help = "standard deviation of the Gaussian that computes the "
                                            "mean; at first 8" },
                                  { .name = "of",
                                    .type = WR_ARG_CHOICE,
                                    .words = of_words,
                                    .help = "source of heights and slopes: the terrain's shape, or "
                                            "the table on a square of one unit" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "remove the colours by height" },
};
WR_ROWS_END(colouring_forms, COLOURING_FORMS);

WR_FORMS(form_colouring, colouring_forms)

const WrCommand wr_command_colouring = {
    .name = "colouring",
    .kind = WR_CLASS_SCENE,
    .form_word = "KIND",
    .form = form_colouring,
    .run = run_colouring,
    .print = print_colouring,
    .of_object = true,
    .help = "colour the surface by height, slope and cavity",
    .details = "Replaces the colour picture, and is updated when a command or a stroke has changed "
               "the heights. Colours are linear.",
    .example = "colouring ramp stops=0,0.1,0.3,0.1;1,0.9,0.9,0.9 steep=0.3,0.25,0.2"
};

/* ---- The command grain: the solid texture of an object ---- */

/* True if there is no solid texture and all its numbers are the defaults. */
static bool untouched(const WrSolidTexture *grain)
{
    const WrSolidTexture *usual = &wr_grains[WR_SOLID_TEXTURE_OFF].usual;
    return grain->kind == WR_SOLID_TEXTURE_OFF && grain->axis == usual->axis &&
           grain->drives == usual->drives &&
           memcmp(grain->light, usual->light, sizeof grain->light) == 0 &&
           memcmp(grain->dark, usual->dark, sizeof grain->dark) == 0 &&
           memcmp(grain->roughness, usual->roughness, sizeof grain->roughness) == 0 &&
           grain->rings == usual->rings && grain->share == usual->share &&
           grain->amount == usual->amount && grain->cells == usual->cells &&
           grain->octaves == usual->octaves && grain->ratio == usual->ratio &&
           grain->edge == usual->edge && grain->height == usual->height;
}

static void print_grain(const WrScene *scene, WrText *text)
{
    const WrSolidTexture *grain = &scene->grain;
    if (untouched(grain)) return;
    wr_text_addf(text, "grain %s axis=%s", wr_grains[grain->kind].name,
                 wr_solid_texture_axes[grain->axis]);
    if (grain->drives != WR_SOLID_TEXTURE_COLOURS)
        wr_text_addf(text, " drives=%s", wr_solid_texture_drives[grain->drives]);
    wr_scene_print_params("grain", NULL, scene, text);
    wr_text_add(text, "\n");
}

static bool run_grain(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    const WrArg *kind = wr_call_arg(call, "KIND");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSolidTexture *grain = &scene->grain;
    if (kind->given && kind->choice != (int)grain->kind) *grain = wr_grains[kind->choice].usual;
    wr_scene_take(call, NULL, scene);
    if (wr_call_given(call, "axis")) grain->axis = (WrSolidTextureAxis)wr_call_choice(call, "axis");
    if (wr_call_given(call, "drives")) grain->drives = 1 + wr_call_choice(call, "drives");
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *axis_choice(int i)
{
    return i < WR_SOLID_TEXTURE_AXES ? wr_solid_texture_axes[i] : NULL;
}

static const char *drive_choice(int i)
{
    return i + 1 < WR_SOLID_TEXTURE_DRIVES ? wr_solid_texture_drives[i + 1] : NULL;
}

static const char *kind_choice(int i)
{
    return i < WR_SOLID_TEXTURE_KINDS ? wr_grains[i].name : NULL;
}

static bool row_grain(WrForm *out)
{
    *out =
        (WrForm){ .args = { { .name = "KIND",
                              .type = WR_ARG_CHOICE,
                              .positional = true,
                              .choice = kind_choice,
                              .help = "pattern. wood: rings about the axis, distorted by noise; "
                                      "marble: bands along it, distorted by creased noise; "
                                      "checker: cubes of two colours; granite: specks; noise: a "
                                      "blend of two colours. Left out, the present one" },
                            { .name = "axis",
                              .type = WR_ARG_CHOICE,
                              .choice = axis_choice,
                              .help = "axis of the object for rings and bands" },
                            { .name = "drives",
                              .type = WR_ARG_CHOICE,
                              .choice = drive_choice,
                              .help = "property that the pattern drives; colour by default" } } };
    return wr_scene_args("grain", NULL, out->args + 3) > 0;
}

const WrCommand wr_command_grain = {
    .name = "grain",
    .kind = WR_CLASS_SCENE,
    .row = row_grain,
    .run = run_grain,
    .print = print_grain,
    .of_object = true,
    .help = "set a solid texture",
    .details = "The object looks carved from the texture, which turns with it. As colour, it is "
               "multiplied by the material's colour and the colour picture; as bump, it is a "
               "height that tilts the normal; as roughness, it varies from smooth to rough. With "
               "dials aa=filter or aa=moments, and on endless ground, detail finer than a pixel is "
               "replaced by its mean. A new kind starts with its usual values; otherwise only "
               "given arguments change. off removes all solid textures.",
    .example = "grain wood rings=12 amount=0.6"
};
