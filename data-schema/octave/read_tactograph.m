% SPDX-License-Identifier: GPL-3.0-or-later
function data = read_tactograph(file)
% Reads a file of tactograph in MATLAB or Octave, in SI units. DATA has one field for each quantity, as a column.
%   NAME.json          recording: time (s), and each channel
%   NAME.texture.json  texture: position (m), and the quantity, for example tangential_force (N)
%   NAME.nc            spectrogram: position (m), spatial_frequency (1/m), and density (frequencies by positions);
%                      or a session that `tactograph session NAME -o NAME.nc` exported: time (s), position (m), drive (V) ...
% data.about is the JSON document (its channels have their units), as far as there is one.
  if strcmp(file(max(1, end - 2):end), '.nc')
    data = netcdf(file);
    return
  end
  about = jsondecode(fileread(file));
  [folder, ~] = fileparts(file);
  wav = fullfile(folder, about.data.file);
  if strcmp(about.kind, 'texture')
    stored = audioread(wav, 'native');
    data.position = (0:rows_of(stored) - 1)' * about.pitch_m;
    data.(about.quantity) = double(stored(:, 1));
  elseif strcmp(about.kind, 'recording')
    stored = double(audioread(wav, 'native'));
    sequence = (0:rows_of(stored) - 1)';
    gaps = listed(about, 'gaps');
    for i = 1:numel(gaps)  % missing frames are counted and not filled
      sequence(gaps{i}.frame + 1:end) = sequence(gaps{i}.frame + 1:end) + gaps{i}.count;
    end
    data.time = sequence / about.sample_rate_hz;
    channels = listed(about, 'channels');
    for i = 1:numel(channels)
      data.(channels{i}.name) = stored(:, i) * channels{i}.scale + channels{i}.offset;
    end
  else
    error('%s is of kind %s; this function reads recordings, textures, spectrograms and exported sessions', file, about.kind);
  end
  data.about = about;
end

function data = netcdf(file)
  if exist('OCTAVE_VERSION', 'builtin')
    data = load('-hdf5', file);  % netCDF-4 is HDF5; no package is needed
  else
    for variable = {ncinfo(file).Variables.Name}
      data.(variable{1}) = ncread(file, variable{1});
    end
  end
  if isfield(data, 'spatial_frequency')  % the file of a spectrogram has millimetres
    factors = struct('position', 1e-3, 'spatial_frequency', 1e3, 'known_from', 1e3, 'known_to', 1e3, 'density', 1e-3);
    for name = intersect(fieldnames(factors), fieldnames(data))'
      data.(name{1}) = double(data.(name{1})) * factors.(name{1});
    end
    if isfield(data, 'density')
      data.density_db = 10 * log10(data.density);
    end
  end
  for name = fieldnames(data)'
    if isvector(data.(name{1}))
      data.(name{1}) = double(data.(name{1})(:));
    end
  end
end

function n = rows_of(samples)
  n = size(samples, 1);
end

function list = listed(document, member)
% jsondecode gives a list of objects as an array of structures, or as cells if their members differ.
  list = {};
  if isfield(document, member) && ~isempty(document.(member))
    list = document.(member);
    if ~iscell(list)
      list = num2cell(list);
    end
  end
end
