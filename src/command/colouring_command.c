/* The command colouring: a picture coloured by height, slope and cavity, computed again when one of its inputs has
   changed. */
#include "command/session_internal.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"
#include "surface/triangles.h"

#include <string.h>

#define FORM_SIDE_MOST 512 /* texels: terrain patches are smooth, more adds no detail */
#define FORM_SIDE_LEAST 64

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
    return size < FORM_SIDE_LEAST ? FORM_SIDE_LEAST : size > FORM_SIDE_MOST ? FORM_SIDE_MOST : size;
}

static WrImage *made_by_form(const WrSession *session, const WrScene *object, WrError *err)
{
    const WrField *like = session->state.document->layers[0].heights;
    return wr_height_colormap_form(&object->colouring, form_of(object), object->shape.value[2],
                                   side_of(wr_field_width(like)), side_of(wr_field_height(like)),
                                   err);
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
            return wr_fail(err, "stop %d is at %g, under the one before it: they must rise", i + 1,
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
                        .help = "from stop to stop; only what is given changes, of a ramp of "
                                "water, sand, meadows, rock and snow over 0..1 to begin with",
                        .args = { { .name = "stops",
                                    .type = WR_ARG_LIST,
                                    .components = 4,
                                    .parts = stop_parts,
                                    .rows_low = 1,
                                    .rows_high = WR_STOPS_MAX,
                                    .shape = "height,r,g,b;...",
                                    .help = "heights as the table or the terrain's picture has "
                                            "them, rising, and their colours; two of one "
                                            "height make a step" },
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
                                    .help = "from which slope on it shows, and from which on it "
                                            "alone, degrees; 30,45 to begin with" },
                                  { .name = "cavity",
                                    .type = WR_ARG_TUPLE,
                                    .components = 3,
                                    .low = 0,
                                    .high = 1e6,
                                    .help = "the colour of hollows: what lies lower than the mean "
                                            "about it" },
                                  { .name = "depth",
                                    .type = WR_ARG_TUPLE,
                                    .components = 2,
                                    .low = 0,
                                    .high = 1e30,
                                    .help = "how far below that it begins to show, and from where "
                                            "on it is alone, as heights; 0.01,0.1 to begin with" },
                                  { .name = "within",
                                    .type = WR_ARG_NUMBER,
                                    .low = 0.05,
                                    .high = 512,
                                    .unit = "texels",
                                    .help = "standard deviation of the mean's Gaussian; 8 to begin "
                                            "with" },
                                  { .name = "of",
                                    .type = WR_ARG_CHOICE,
                                    .words = of_words,
                                    .help = "whose heights and slopes: the terrain's form, or "
                                            "the table's, as it lies on a square of one unit" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "no colours of heights" },
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
    .help = "colours by height, slope and cavity",
    .details =
        "It stands in the place of a colour picture, and is made anew when a command, or a stroke, "
        "has changed the heights. Colours are linear.",
    .example = "colouring ramp stops=0,0.1,0.3,0.1;1,0.9,0.9,0.9 steep=0.3,0.25,0.2"
};
