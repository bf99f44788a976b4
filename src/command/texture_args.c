#include "command/texture_args.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "command/scene_args.h"
#include "document/document.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Print source and tiling of a picture: " FILE channel=... part=... sha256=... repeat=...". */
void wr_print_laid(const WrTextureSample *laid, bool named, WrText *text)
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

bool wr_check_repeat(const void *ctx, const char *name, const char *value, WrError *err)
{
    WrTextureSample repeat;
    (void)ctx;
    if (repeat_parse(value, &repeat)) return true;
    return wr_fail(err, "%s=%.40s: must be table, once, or two numbers ru,rv, -1e9..1e9", name,
                   value);
}

/* Store the line's repeat= value; the words are not borrowed. */
void wr_take_repeat(const WrCall *call, WrTextureSample *laid)
{
    if (wr_call_given(call, "repeat")) repeat_parse(wr_call_arg(call, "repeat")->text, laid);
}

/* Set the source to another file; tiling as the table's, unless the line has repeat=. */
void wr_take_laid(WrCall *call, const char *name, WrTextureSample *laid)
{
    const char *hex = wr_call_arg(call, "sha256")->text;
    const WrImageRequest wish = wr_call_request(call);
    wr_texture_sample_fini(laid);
    if (!name) return;
    laid->path = wr_strdup(name);
    laid->channel = wr_strdup(wish.channel);
    laid->part = wr_strdup(wish.part);
    if (hex) memcpy(laid->sha256, hex, 64);
    wr_take_repeat(call, laid);
}

/* The picture that a line names: while a document loads, its embedded one, else the file's. The caller frees it. */
WrImage *wr_find_laid(WrSession *session, WrCall *call, const char *name, int which, WrError *err)
{
    if (session->loading) {
        const int object = session->state.document->scene->chosen;
        const WrImage *held = session->embedded ? session->embedded[object][which] : NULL;
        if (held) return wr_image_share(held);
        wr_fail(err, "the document names the picture %s but does not hold it", name);
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

/* Arguments of a file are refused in a line without a file. */
bool wr_refuse_without(const WrCall *call, const char *const *names, const char *why, WrError *err)
{
    for (; *names; names++)
        if (wr_call_given(call, *names)) return wr_fail(err, "%s %s=", why, *names);
    return true;
}
