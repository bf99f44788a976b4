/* What of a strangers' picture the session remembers: its hash, its part, its note. */
#include "command/inner.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document_file.h"
#include "image/gltf.h"

#include <string.h>

/* ---- files ---- */

bool wr_input_sha256(const char *path, char hex[65], WrError *err)
{
    WrText text = { 0 };
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

WrImageWish wr_call_wish(WrCall *call)
{
    return (WrImageWish){ .channel = wr_call_arg(call, "channel")->text,
                          .part = wr_call_arg(call, "part")->text };
}

void wr_session_note_read(WrSession *session, const char *path, const WrImage *image)
{
    if (image->taken[0])
        wr_session_note(session, "%s: took %s (channel= and part= take others)", path,
                        image->taken);
    if (image->replaced)
        wr_session_note(session, "%s: %lld values were not finite and became 0", path,
                        (long long)image->replaced);
}
