! The bearing as a user element of Abaqus/Standard, over liblir_element.so.
!
!   *USER ELEMENT, TYPE=U1, NODES=2, COORDINATES=3, VARIABLES=@LIR_SIZE@, I PROPERTIES=1, PROPERTIES=0, UNSYMM
!   1, 2, 3, 4, 5, 6
!   *ELEMENT, TYPE=U1, ELSET=BEARINGS
!   101, 1, 2
!   *UEL PROPERTY, ELSET=BEARINGS
!   7
!
! The integer property n names the file bearing_n.lir in the job's folder. Node 1 is below, z points
! upwards, units are SI. Use *DYNAMIC with NOHAF, and UNSYMM=YES on the step. If a bearing has no
! state the increment is cut. The state lies in SVARS, which Abaqus resets for each iteration.
! Run `abaqus job=... user=uel.f90`, with the library in link_sl of abaqus_v6.env.

subroutine uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, &
               nnode, u, du, v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, &
               adlmag, predef, npredf, lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period)
  use, intrinsic :: iso_c_binding
  implicit none
  integer :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, npredf
  integer :: mlvarx, mdload, njprop, jdltyp(mdload, *), lflags(*), jprops(*)
  real(8) :: rhs(mlvarx, *), amatrx(ndofel, ndofel), svars(nsvars), energy(8), props(*)
  real(8) :: coords(mcrd, nnode), u(ndofel), du(mlvarx, *), v(ndofel), a(ndofel), time(2), dtime
  real(8) :: params(3), adlmag(mdload, *), predef(2, npredf, nnode), ddlmag(mdload, *), pnewdt, period

  interface
    integer(c_int) function lir_read(path, bearing, room) bind(c)
      import; character(c_char) :: path(*); real(c_double) :: bearing(*); integer(c_int), value :: room
    end function
    integer(c_int) function lir_size(bearing) bind(c)
      import; real(c_double) :: bearing(*)
    end function
    integer(c_int) function lir_trial(bearing, u, v, time) bind(c)
      import; real(c_double) :: bearing(*), u(12), v(12); real(c_double), value :: time
    end function
    subroutine lir_force(bearing, force) bind(c)
      import; real(c_double) :: bearing(*), force(12)
    end subroutine
    subroutine lir_tangent(bearing, tangent) bind(c)
      import; real(c_double) :: bearing(*), tangent(12, 12)
    end subroutine
    integer(c_int) function lir_commit(bearing) bind(c)
      import; real(c_double) :: bearing(*)
    end function
  end interface

  integer, parameter :: committed = @LIR_COMMITTED@ + 1  ! lir_element.h; from 1
  integer, parameter :: old = @LIR_COMMITTED@ + 1, new = @LIR_TRIAL@ + 1  ! lir_element.h, from 1
  real(8) :: before(12), force(12), tangent(12, 12), alpha, now
  character(256) :: folder, path
  integer :: length, code

  if (lir_size(svars) == 0) then
    call getoutdir(folder, length)
    write (path, '(2a, i0, a)') folder(:length), '/bearing_', jprops(1), '.lir'
    code = lir_read(trim(path)//c_null_char, svars, nsvars)
    if (code /= 0) call give_up('cannot be read (lir_element.h): '//trim(path))
  end if
  code = int(transfer(svars(old + @LIR_STATUS@), 0_c_int64_t))
  if (code /= 0) call give_up('has failed in the last increment')
  if (lflags(3) == 5) call give_up('has no half-increment residual: use NOHAF')

  rhs(:12, 1) = 0.0d0
  amatrx = 0.0d0
  if (lflags(3) == 3 .or. lflags(3) == 4) return  ! damping, mass
  before = svars(old + @LIR_FORCE@ : old + @LIR_FORCE@ + 11)
  now = svars(old)
  alpha = 0.0d0
  if ((lflags(1) == 11 .or. lflags(1) == 12) .and. lflags(3) /= 6) then
    now = now + dtime
    alpha = params(1)
  end if
  code = lir_trial(svars, u, v, now)
  if (code /= 0) then
    pnewdt = 0.25d0
    return
  end if
  call lir_force(svars, force)
  rhs(:12, 1) = -(1.0d0 + alpha) * force + alpha * before
  if (lflags(3) == 6) return
  call lir_tangent(svars, tangent)
  if (kstep == 1 .and. max(svars(old + @LIR_AXIAL_FORCE@), svars(new + @LIR_AXIAL_FORCE@)) <= 0.0d0) &
    tangent = reshape(svars(@LIR_INITIAL@ + 1 : @LIR_INITIAL@ + 144), [12, 12])  ! not loaded yet
  amatrx = (1.0d0 + alpha) * transpose(tangent)  ! C has it by rows
  if (lflags(3) == 1) code = lir_commit(svars)

contains

  subroutine give_up(why)
    character(*), intent(in) :: why
    write (7, '(a, i0, 3a, i0)') 'bearing element ', jelem, ' ', why, ', code ', code
    call xit
  end subroutine
end subroutine
