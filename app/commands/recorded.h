#pragma once

#include <filesystem>

#include "hal/replay/sequence.h"

/// Nothing recorded is ever overwritten: what keeps results of the commands away from it. Links are
/// followed, also one to a file that is not there yet, and so is "..".
namespace lumibox::app {

/// Throws config::InputError if `result`, a file or folder to be written, is or would lie in what
/// any capture has recorded: its transforms.json, points.ply, images and map. Other names in a
/// capture's folder are free.
void refuse_recorded(const std::filesystem::path& result);

/// The same, and of the capture in this folder even if its images or map are links to elsewhere.
void refuse_recorded(const std::filesystem::path& result, const std::filesystem::path& capture);

/// Throws config::InputError if `result` would replace a file that the sequence is read from, or
/// would be read as one of its files from then on.
void refuse_recorded(const std::filesystem::path& result, const hal::Sequence& sequence);

/// Throws config::InputError if `result` is the folder of a capture or would lie anywhere in it.
void refuse_inside(const std::filesystem::path& result, const std::filesystem::path& capture);

}  // namespace lumibox::app
