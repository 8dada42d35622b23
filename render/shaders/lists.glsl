// Lists of layers, nearest first, one after the other: each byte a layer, END_OF_LIST after the last.
layout(std140) uniform Lists {
  uvec4 lists[MAX_ENTRIES / 16];
};

int entry_of(int at) {
  return int(lists[at >> 4][(at >> 2) & 3] >> (8 * (at & 3))) & 255;
}
