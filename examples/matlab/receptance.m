% The natural frequencies of a body, and a receptance of it, in MATLAB or Octave.
%
%   chladni run ../response/scene.toml --output out
%   receptance                   % in MATLAB, in the folder of out
%
% Octave cannot read the texts of the file. For it two lines of Python write the arrays to a file of its own:
%
%   python3 -c 'import h5py, scipy.io; body = h5py.File("out/tap.body.h5")
%   scipy.io.savemat("tap.mat", {"omega": body["modes/frequencies"][:], "phi": body["modes/attachment_displacements"][:]})'
%   octave receptance.m
%
% It prints the frequencies and writes receptance.csv: Hz, and the real and imaginary part of the
% displacement in m of the output node for each N at the load node. The body has no damping of its own.

if exist('tap.mat', 'file')
  load tap.mat
else
  omega = h5read('out/tap.body.h5', '/modes/frequencies');               % rad/s
  phi = h5read('out/tap.body.h5', '/modes/attachment_displacements')';   % MATLAB reverses the extents
end
omega = omega(:);
fprintf('mode %d: %.3f Hz\n', [1:numel(omega); omega' / (2 * pi)]);

z = 3;                        % components: x y z rx ry rz, the rows of each node in turn
load_node = 1;                % rows of attachment/node_numbers from 1, here the first node of the track
output_node = 1;
phi_load = phi(6 * (load_node - 1) + z, :);
phi_output = phi(6 * (output_node - 1) + z, :);

% (diag(omega^2) (1 + i eta) - Omega^2 I) q = phi_load' * 1 N, u = phi_output q
eta = 0.002;
f_Hz = linspace(100, 5000, 981)';
u = zeros(size(f_Hz));
for k = 1:numel(f_Hz)
  Omega = 2 * pi * f_Hz(k);
  u(k) = sum(phi_output .* phi_load ./ (omega.^2 * (1 + 1i * eta) - Omega^2).');
end

file = fopen('receptance.csv', 'w');
fprintf(file, '%.17g,%.17g,%.17g\n', [f_Hz, real(u), imag(u)]');
fclose(file);
