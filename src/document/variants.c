/* Names of variants: one a line in WrDocument.variants. */
#include "document/variants.h"

#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"

#include <string.h>

/* The next line of *at, without its end; false: there is none. */
static bool next_line(const char **at, const char **line, size_t *length)
{
    if (!*at || !**at) return false;
    *line = *at;
    *length = strcspn(*at, "\n");
    *at += *length + ((*at)[*length] == '\n');
    return true;
}

int wr_variant_count(const WrDocument *document)
{
    const char *at = document->variants, *line;
    size_t length;
    int count = 0;
    while (next_line(&at, &line, &length)) count++;
    return count;
}

void wr_variant_name(const WrDocument *document, int i, char name[WR_VARIANT_NAME_MAX + 1])
{
    const char *at = document->variants, *line = "";
    size_t length = 0;
    for (; i >= 0 && next_line(&at, &line, &length); i--) continue;
    memcpy(name, line, length);
    name[length] = '\0';
}

int wr_variant_find(const WrDocument *document, const char *name)
{
    const char *at = document->variants, *line;
    size_t length;
    for (int i = 0; next_line(&at, &line, &length); i++)
        if (strlen(name) == length && memcmp(name, line, length) == 0) return i;
    return -1;
}

static bool is_allowed(const char *line, size_t length)
{
    bool allowed = length > 0 && length <= WR_VARIANT_NAME_MAX;
    for (size_t k = 0; k < length && allowed; k++)
        allowed = (unsigned char)line[k] >= 0x20 && line[k] != 0x7F;
    return allowed;
}

static void put(WrDocument *document, WrText *names)
{
    wr_free(document->variants);
    document->variants = names->length ? wr_strdup(wr_text_get(names)) : NULL;
    wr_text_fini(names);
}

void wr_document_set_variants(WrDocument *document, const char *names, const char *in_use)
{
    const char *line;
    size_t length;
    wr_free(document->variants);
    wr_free(document->variant);
    document->variants = document->variant = NULL;
    for (int count = 0; count < WR_VARIANTS_MAX && next_line(&names, &line, &length);) {
        char *name = wr_strndup(line, length);
        const bool takes = is_allowed(line, length) && wr_variant_find(document, name) < 0;
        if (takes) wr_variant_put_name(document, count++, name);
        wr_free(name);
    }
    if (in_use && wr_variant_find(document, in_use) >= 0) document->variant = wr_strdup(in_use);
    for (int i = 0; i < document->layer_count && !document->variants; i++) {
        wr_free(document->layers[i].values);
        document->layers[i].values = NULL;
    }
}

void wr_variant_put_name(WrDocument *document, int i, const char *name)
{
    const char *at = document->variants, *line;
    size_t length;
    WrText names = { 0 };
    for (int k = 0; next_line(&at, &line, &length); k++)
        if (k != i) wr_text_addf(&names, "%.*s\n", (int)length, line);
        else if (name) wr_text_addf(&names, "%s\n", name);
    if (name && i == wr_variant_count(document)) wr_text_addf(&names, "%s\n", name);
    put(document, &names);
}
