struct Layer {
  // Source = (from_x * x + from_y * y + from_1).xyz at a fragment's place from the middle of the
  // view: homogeneous, in pixels, or with DISTORTION or SHAPE in normalised coordinates, with SHAPE
  // at infinity. Beside them in w: slot of the picture; weight or alpha; gain.
  vec4 from_x;
  vec4 from_y;
  vec4 from_1;
  // A plane lies before the view where dot(beyond, (x, y, 1)) > 0. SHAPE: the source moves by this
  // times the inverse depth; w is the slot of its depth map, below 0 if it has none.
  vec4 beyond;
  vec4 picture;     // width - 1, height - 1, 1 / feather width, samples of its map per pixel
  vec4 intrinsics;  // fx fy cx cy
  vec4 distortion;  // as pixel_of() has it
  vec4 lens;        // k3, squared radius of the fold, 1 if a fisheye lens
};

layout(std140) uniform Layers {
  Layer layers[MAX_LAYERS];
};
