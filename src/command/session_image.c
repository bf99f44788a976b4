/* Reading of pictures for commands: checksum, part, note. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document_file.h"
#include "image/gltf.h"
#include "image/gltf_material.h"
#include "image/image.h"

#include <string.h>

/* ---- files ---- */

/* Bytes of a picture in a glTF file. */
static bool picture_bytes(const char *name, size_t length, int image, char **bytes, size_t *size,
                          WrError *err)
{
    char *path = wr_strdup(name);
    path[length] = 0;
    const bool good = wr_gltf_picture(path, image, bytes, size, err);
    wr_free(path);
    return good;
}

WrImage *wr_input_image(const char *path, const WrImageRequest *wish, WrError *err)
{
    size_t length, size;
    int index;
    char *bytes;
    WrText name = { 0 };
    if (!wr_gltf_names_picture(path, &length, &index)) return wr_image_read_wish(path, wish, err);
    if (wish->channel || wish->part) {
        wr_fail(err, "%s: channel= and part= are of picture files, not of pictures in a glTF",
                path);
        return NULL;
    }
    if (!picture_bytes(path, length, index, &bytes, &size, err)) return NULL;
    /* glTF allows only PNG and JPEG; the extension selects the decoder */
    const bool png = size > 4 && memcmp(bytes, "\x89PNG", 4) == 0;
    const bool jpeg = size > 2 && memcmp(bytes, "\xff\xd8", 2) == 0;
    WrImage *image = NULL;
    wr_text_addf(&name, "%s.%s", path, png ? "png" : "jpg");
    if (png || jpeg) image = wr_image_read_bytes(wr_text_get(&name), bytes, size, err);
    else wr_fail(err, "%s: is neither PNG nor JPEG", path);
    wr_text_fini(&name);
    wr_free(bytes);
    return image;
}

bool wr_input_sha256(const char *path, char hex[65], WrError *err)
{
    WrText text = { 0 };
    size_t length, size;
    int image;
    char *bytes;
    if (wr_gltf_names_picture(path, &length, &image)) {
        if (!picture_bytes(path, length, image, &bytes, &size, err)) return false;
        wr_sha256_bytes(bytes, size, hex);
        wr_free(bytes);
        return true;
    }
    bool packed, good = wr_gltf_pack(path, &text, &packed, err);
    if (good && packed) wr_sha256_bytes(text.data, text.length, hex);
    else if (good) good = wr_sha256_file(path, hex, err);
    wr_text_fini(&text);
    return good;
}

bool wr_session_check_sha256(WrCall *call, const char *path, WrError *err)
{
    char hex[65];
    return wr_input_sha256(path, hex, err) && wr_call_check_sha256(call, "sha256", path, hex, err);
}

bool wr_call_check_sha256(WrCall *call, const char *name, const char *path, const char *hex,
                          WrError *err)
{
    const WrArg *arg = wr_call_arg(call, name);
    if (arg->given && strcmp(arg->text, hex) != 0)
        return wr_fail(err, "%s: another content than this line was written for: its SHA-256 is %s",
                       path, hex);
    if (!arg->given) wr_call_set_text(call, name, hex);
    return true;
}

WrImageRequest wr_call_request(WrCall *call)
{
    return (WrImageRequest){ .channel = wr_call_arg(call, "layer")->text,
                             .part = wr_call_arg(call, "part")->text };
}

void wr_session_note_read(WrSession *session, const char *path, const WrImage *image)
{
    if (image->taken[0])
        wr_session_note(session, "%s: took %s (channel= and part= take others)", path,
                        image->taken);
    if (image->note[0]) wr_session_note(session, "%s: %s", path, image->note);
    if (image->filled)
        wr_session_note(session, "%s: %lld missing values filled from their neighbours", path,
                        (long long)image->filled);
    if (image->replaced)
        wr_session_note(session, "%s: %lld values were not finite and became 0", path,
                        (long long)image->replaced);
}
