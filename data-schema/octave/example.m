% SPDX-License-Identifier: GPL-3.0-or-later
% Draws a recording, its texture, its spectrogram and a session, in MATLAB or Octave. Before, in a shell:
%   tactograph record -d sim:surface=E,speed=50mm/s,seed=1 --time 2s -o E
%   tactograph spatial E -o E --stroke 1
%   tactograph spectrogram E -o E.nc
%   tactograph play E -d sim: -o first --time 1s && tactograph session first -o first.nc
% The four plots are written to example.png.
figure('visible', 'off');

recording = read_tactograph('E.json');
subplot(2, 2, 1); plot(recording.time, recording.tangential_force);
xlabel('time (s)'); ylabel('tangential force (N)');

texture = read_tactograph('E.texture.json');
subplot(2, 2, 2); plot(texture.position, texture.tangential_force);
xlabel('position (m)'); ylabel(['tangential force (' texture.about.unit ')']);

spectrogram = read_tactograph('E.nc');
subplot(2, 2, 3); imagesc(spectrogram.position, spectrogram.spatial_frequency, spectrogram.density_db, [-120 -60]);
axis xy; xlabel('position (m)'); ylabel('spatial frequency (1/m)'); title('density (dB re 1 N^2 m)');

session = read_tactograph('first.nc');
subplot(2, 2, 4); plot(session.time, session.drive);
xlabel('time (s)'); ylabel('drive (V)');

print('example.png', '-dpng');
