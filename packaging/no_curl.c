// SPDX-License-Identifier: MIT
// Stands for libcurl in the wheel: Debian's HDF5 is linked with it for files on
// remote servers, which beamgyro never opens. HDF5 asks for curl_global_init()
// first and takes its failure for an error of the open.
#include <stddef.h>

enum { kFailedInit = 2 };  // CURLE_FAILED_INIT

int curl_global_init(long flags);
void curl_global_cleanup(void);
void* curl_easy_init(void);
int curl_easy_setopt(void* handle, int option, ...);
int curl_easy_perform(void* handle);
void curl_easy_cleanup(void* handle);
void* curl_slist_append(void* list, const char* text);
void curl_slist_free_all(void* list);

int curl_global_init(long flags) {
  (void)flags;
  return kFailedInit;
}

void curl_global_cleanup(void) {}

void* curl_easy_init(void) { return NULL; }

int curl_easy_setopt(void* handle, int option, ...) {
  (void)handle;
  (void)option;
  return kFailedInit;
}

int curl_easy_perform(void* handle) {
  (void)handle;
  return kFailedInit;
}

void curl_easy_cleanup(void* handle) { (void)handle; }

void* curl_slist_append(void* list, const char* text) {
  (void)list;
  (void)text;
  return NULL;
}

void curl_slist_free_all(void* list) { (void)list; }
