#include "document/document.h"

#include "base/memory.h"
#include "document/composite.h"

#include <string.h>

#define NEW_SIZE 512 /* texels along a side of an empty document */

WrDocument *wr_document_new(void)
{
    WrError err;
    WrDocument *document = wr_alloc(1, sizeof *document);
    document->layers = wr_alloc(1, sizeof *document->layers);
    document->layer_count = 1;
    document->layers[0].name = wr_strdup("base");
    document->layers[0].field =
        wr_field_new(NEW_SIZE, NEW_SIZE, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err);
    document->scene = wr_scene_new();
    document->composite = wr_composite_new();
    return document;
}

WrDocument *wr_document_share(const WrDocument *document)
{
    WrDocument *copy = wr_alloc(1, sizeof *copy);
    int count = document->layer_count;
    copy->layers = wr_alloc((size_t)count, sizeof *copy->layers);
    copy->layer_count = count;
    for (int i = 0; i < count; i++) {
        copy->layers[i].name = wr_strdup(document->layers[i].name);
        copy->layers[i].field = wr_field_share(document->layers[i].field);
    }
    copy->scene = wr_scene_share(document->scene);
    copy->composite = wr_composite_share(document->composite);
    return copy;
}

void wr_document_free(WrDocument *document)
{
    if (!document) return;
    for (int i = 0; i < document->layer_count; i++) {
        wr_free(document->layers[i].name);
        wr_field_free(document->layers[i].field);
    }
    wr_free(document->layers);
    wr_scene_free(document->scene);
    wr_composite_free(document->composite);
    wr_free(document);
}

const WrField *wr_document_field(const WrDocument *document)
{
    if (document->layer_count == 1) return document->layers[0].field;
    return wr_composite_update(document->composite, document->layers, document->layer_count);
}

WrHash wr_document_hash(const WrDocument *document, const char *scene_text)
{
    int32_t count = document->layer_count;
    WrHash hash = wr_hash_bytes(&count, sizeof count, (WrHash){ 0, 0 });
    for (int i = 0; i < count; i++) {
        const char *name = document->layers[i].name;
        WrHash heights = wr_field_hash(document->layers[i].field);
        hash = wr_hash_bytes(name, strlen(name) + 1, hash);
        hash = wr_hash_bytes(&heights, sizeof heights, hash);
    }
    return wr_hash_bytes(scene_text, strlen(scene_text), hash);
}
